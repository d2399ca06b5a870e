/* Copyright 2026 The stickslip authors
   SPDX-License-Identifier: Apache-2.0

   An axis as an FMU for co-simulation, FMI 3.0 and 2.0, on what stickslip_axis.h promises.  The scene and the table of
   its variables are read from resources/axis.txt.  FMI's types are declared here as far as they are used; -DSTICKSLIP_FMI_HEADERS takes the official
   headers instead, which so check each function. */

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stickslip_axis.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"    // FMI gives more than an axis needs

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

#ifdef STICKSLIP_FMI_HEADERS
#include "fmi2Functions.h"
#include "fmi3Functions.h"
#else
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef enum { fmi3Independent } fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown } fmi3IntervalQualifier;
typedef void (*fmi3LogMessageCallback)(void *, fmi3Status, const char *, const char *);
typedef void (*fmi3IntermediateUpdateCallback)(void *, double, bool, bool, bool, bool, bool *, double *);
typedef void (*fmi3ClockUpdateCallback)(void *);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);
typedef struct {
    void (*logger)(void *, const char *, fmi2Status, const char *, const char *, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(void *, fmi2Status);
    void *componentEnvironment;
} fmi2CallbackFunctions;
#endif

typedef const uint32_t refs_3[];
typedef const unsigned refs_2[];

enum { NEW = 1, STARTING = 2, EVENT = 4, STEP = 8, ENDED = 16, ANY = 31 };    /* phases */
enum { TIME, DRIVE_COMMAND, NORMAL_COMMAND = 3, MODE = 10, REST_TIME = 22, COUNT = 30, EVENT_TIME, EVENT_KIND, VALUES = 56 };
enum { REAL, WHOLE, COMMAND, TUNED };    /* what a variable is */
enum { VARIABLES, PARAMETERS, INITIAL, SINUSOIDS, DRIVE, FORCE, NORMAL, SECTIONS };    /* of resources/axis.txt */

/* A variable, as modelDescription.xml has it; one that is tuned sets a field or two of the parameters. */
typedef struct { double reference, is, start, low, high, field, other; } Variable;

/* What belongs to a state beside the numbers of the axis; values and commands stand at their value references. */
typedef struct {
    double phase, is_started, has_new_inputs, has_new_parameters, has_sample, start;
    double is_commanded[NORMAL_COMMAND + 1], value[VALUES];
} Own;

typedef struct {
    uint64_t id, sum;    /* of the scene; of what follows */
    Own own;
    double numbers[];    /* of the axis */
} Saved;

typedef struct {
    Own own, first;                    /* now, and before anything was set */
    axis *axis;
    uint64_t id;                       /* of the scene */
    double *numbers, *scratch, *section[SECTIONS];
    size_t size[SECTIONS];
    const Variable *variable[VALUES];  /* at their value references */
    axis_sinusoid *rows;
    bool has_event_mode, stops;
    void *environment;
    fmi3LogMessageCallback log_3;
    const fmi2CallbackFunctions *functions_2;
    char name[64];
} Instance;

static int refuse(Instance *i, const char *format, ...)
{
    char text[512];
    va_list words;
    va_start(words, format);
    vsnprintf(text, sizeof text, format, words);
    va_end(words);
    if (i->log_3 != NULL) {
        i->log_3(i->environment, fmi3Error, "logStatusError", text);
    }
    if (i->functions_2 != NULL && i->functions_2->logger != NULL) {
        i->functions_2->logger(i->environment, i->name, fmi2Error, "logStatusError", "%s", text);
    }
    return fmi3Error;
}

static int done(Instance *i, int code)
{
    return code == AXIS_OK ? fmi3OK : refuse(i, "at %.17g s: %s", i->own.start + axis_time(i->axis), axis_text(code));
}

static bool is_in(Instance *i, int phases, const char *what)
{
    bool is = ((int)i->own.phase & phases) != 0;
    if (!is) {
        refuse(i, "%s is not allowed now: the FMU is %s", what, i->own.phase == NEW ? "not initialized"
               : i->own.phase == STARTING ? "in initialization mode" : i->own.phase == EVENT ? "in event mode"
               : i->own.phase == STEP ? "in step mode" : "terminated: reset it");
    }
    return is;
}

static uint64_t sum_of(const void *words, size_t bytes)    /* FNV-1a */
{
    uint64_t sum = 14695981039346656037u, bits;
    for (const char *at = words, *end = at + bytes; at < end; at += sizeof bits) {
        memcpy(&bits, at, sizeof bits);
        sum = (sum ^ bits) * 1099511628211u;
    }
    return sum;
}

/* The scene */

static void path_of(const char *folder, char *out, const char *end)
{
    bool is_uri = strncmp(folder, "file:", 5) == 0;
    folder += is_uri ? 5 : 0;
    folder += is_uri && strncmp(folder, "//", 2) == 0 ? 2 : 0;
    for (unsigned code; *folder != 0 && out < end; folder++) {
        bool is_coded = is_uri && sscanf(folder, "%%%2x", &code) == 1;
        *out++ = is_coded ? (char)code : *folder;
        folder += is_coded ? 2 : 0;
    }
    strcpy(out, "/axis.txt");
}

/* Read the token, how many numbers follow and their sum; then the bits of the numbers, each section behind its size. */
static bool read_scene(Instance *i, const char *folder, const char *token)
{
    char path[4096], known[128] = "";
    size_t count = 0, read = 0;
    path_of(folder, path, path + sizeof path - 16);
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        return refuse(i, "%s cannot be opened: unpack the FMU whole", path) == fmi3OK;
    }
    bool is_of_token = fscanf(file, "%127s %zu %" SCNx64, known, &count, &i->id) == 3 && strcmp(known, token) == 0;
    if (is_of_token && count < 10000000 && (i->numbers = calloc(count + 1, sizeof(double))) != NULL) {
        for (uint64_t bits; read < count && fscanf(file, "%" SCNx64, &bits) == 1; read++) {
            memcpy(&i->numbers[read], &bits, sizeof bits);
        }
    }
    fclose(file);
    bool is_whole = read > 0 && read == count && sum_of(i->numbers, count * sizeof(double)) == i->id;
    if (!is_of_token || !is_whole) {
        refuse(i, is_of_token ? "%s is damaged: unpack the FMU again"
               : "%s is not of this instantiation token: take the one of modelDescription.xml", path);
    }
    return is_of_token && is_whole;
}

static bool take_scene(Instance *i)
{
    double *at = i->numbers;
    for (size_t k = 0; k < SECTIONS; k++, at += i->size[k - 1]) {
        i->size[k] = (size_t)*at++;
        i->section[k] = at;
    }
    i->first.phase = NEW;
    for (double *row = i->section[VARIABLES]; row < i->section[PARAMETERS] - 1; row += sizeof(Variable) / sizeof *row) {
        const Variable *one = (const Variable *)row;
        i->variable[(size_t)one->reference] = one;
        i->first.value[(size_t)one->reference] = one->start;
    }
    i->own = i->first;
    i->scratch = calloc(i->size[PARAMETERS], sizeof(double));
    i->rows = calloc(i->size[SINUSOIDS] + 1, sizeof(double));
    return i->scratch != NULL && i->rows != NULL;
}

/* The axis */

/* Count the events that a call brought; return its code. */
static int noted(Instance *i, int code)
{
    for (size_t k = 0; k < axis_event_count(i->axis); k++) {
        axis_event event = axis_event_at(i->axis, k);
        i->own.value[COUNT]++;
        i->own.value[EVENT_TIME] = i->own.start + (event.second + event.fraction);
        i->own.value[EVENT_KIND] = event.kind;
    }
    i->own.has_sample = 0.0;
    return code;
}

/* The parameters as they are tuned; a factor on all friction stands behind their fields. */
static const double *tuned_parameters(Instance *i, const double *value)
{
    double *p = i->scratch;
    memcpy(p, i->section[PARAMETERS], i->size[PARAMETERS] * sizeof(double));
    for (size_t ref = 0; ref < VALUES; ref++) {
        const Variable *one = i->variable[ref];
        if (one == NULL || one->is != TUNED || value[ref] == one->start) {
            continue;
        }
        if (one->field == AXIS_PARAMETERS) {
            axis_scale_friction(p, i->size[PARAMETERS], value[ref] / one->start);
        } else {
            p[(size_t)one->field] = p[(size_t)one->other] = value[ref];
        }
    }
    return p;
}

static axis_inputs inputs_in_force(Instance *i)
{
    const double *is = i->own.is_commanded + DRIVE_COMMAND;
    axis_inputs inputs = {.normal_varies = i->size[NORMAL] > 0, .sinusoids = i->rows};
    axis_profile *const profiles[] = {&inputs.drive, &inputs.force, &inputs.normal};
    for (size_t k = 0; k < sizeof profiles / sizeof *profiles; k++) {
        const double *of = i->section[DRIVE + k];
        size_t n = i->size[DRIVE + k] / 3;
        *profiles[k] = is[k] != 0.0 ? (axis_profile){.value = i->own.value[DRIVE_COMMAND + k]}
            : (axis_profile){.count = n, .period = of[0], .starts = of + 1, .values = of + 1 + n, .rates = of + 1 + 2 * n};
    }
    const axis_sinusoid *all = (const axis_sinusoid *)i->section[SINUSOIDS], *end = all + i->size[SINUSOIDS] / 5;
    for (const axis_sinusoid *one = all; one < end; one++) {    /* those of inputs that are not commanded */
        if ((one->v == 0.0 || is[0] == 0.0) && (one->f == 0.0 || is[1] == 0.0) && (one->n == 0.0 || is[2] == 0.0)) {
            i->rows[inputs.sinusoid_count++] = *one;
        }
    }
    return inputs;
}

/* Return an axis that begins with what is set now; NULL and a code where there is none. */
static axis *started(Instance *i, int *code)
{
    axis_inputs inputs = inputs_in_force(i);
    size_t count = i->size[PARAMETERS], sinusoids = i->size[SINUSOIDS] / 5;
    axis *made = axis_new(tuned_parameters(i, i->own.value), count, sinusoids, 4, false, code);
    if (made != NULL && (*code = axis_start(made, (const axis_start_state *)i->section[INITIAL], &inputs)) != AXIS_OK) {
        axis_free(made);
        made = NULL;
    }
    return made;
}

/* Let what was set act from the present time on, before anything is read or goes on. */
static bool obey(Instance *i)
{
    int code = AXIS_OK;
    Own *own = &i->own;
    axis *made = own->is_started == 0.0 ? started(i, &code) : NULL;
    if (made != NULL) {
        axis_free(i->axis);
        i->axis = made;
        own->is_started = 1.0;
        own->value[COUNT] = own->value[EVENT_TIME] = own->has_new_inputs = own->has_new_parameters = 0.0;
        own->value[EVENT_KIND] = -1.0;
        noted(i, code);
    }
    if (code == AXIS_OK && own->has_new_inputs != 0.0) {
        axis_inputs inputs = inputs_in_force(i);
        code = noted(i, axis_set_inputs(i->axis, &inputs));
        own->has_new_inputs = 0.0;
    }
    if (code == AXIS_OK && own->has_new_parameters != 0.0) {
        code = noted(i, axis_set_parameters(i->axis, tuned_parameters(i, own->value), i->size[PARAMETERS]));
        own->has_new_parameters = 0.0;
    }
    return done(i, code) == fmi3OK;
}

/* Values */

static bool get(Instance *i, unsigned ref, bool is_whole, double *out)
{
    const Variable *one = ref < VALUES ? i->variable[ref] : NULL;
    if (one == NULL || is_whole != (one->is == WHOLE)) {
        return refuse(i, "value reference %u is no %s of this FMU: take those of modelDescription.xml", ref,
                      is_whole ? "whole number" : "real number") == fmi3OK;
    }
    if (one->is < COMMAND && !obey(i)) {
        return false;
    }
    if (ref >= MODE && ref <= REST_TIME && i->own.has_sample == 0.0) {
        axis_sample_row row;
        int code = axis_sample(i->axis, &row);
        if (done(i, code) != fmi3OK) {
            return false;
        }
        memcpy(i->own.value + MODE, &row.mode, (REST_TIME - MODE + 1) * sizeof row.mode);
        i->own.has_sample = 1.0;
    }
    *out = ref == TIME ? i->own.start + axis_time(i->axis) : i->own.value[ref];
    return true;
}

/* Take all values or, where one is wrong, none. */
static int set(Instance *i, const uint32_t *refs, size_t n, const double *values)
{
    Own next = i->own;
    for (size_t k = 0; k < n; k++) {
        const Variable *one = refs[k] < VALUES ? i->variable[refs[k]] : NULL;
        if (one == NULL || one->is < COMMAND) {
            return refuse(i, "value reference %u cannot be set: only inputs and parameters can", (unsigned)refs[k]);
        }
        if (!(values[k] >= one->low && values[k] <= one->high)) {
            return refuse(i, "value reference %u is set to %g: allowed is %g to %g; what was set before stays",
                          (unsigned)refs[k], values[k], one->low, one->high);
        }
        double *to = &next.value[refs[k]], value = values[k] + 0.0;
        if (one->is == TUNED && *to != value) {
            next.has_new_parameters = 1.0;
        }
        if (one->is == COMMAND && (*to != value || next.is_commanded[refs[k]] == 0.0)) {
            next.has_new_inputs = next.is_commanded[refs[k]] = 1.0;
        }
        *to = value;
    }
    const double *p = tuned_parameters(i, next.value), *back = p + AXIS_PARAMETERS + 6 * (size_t)p[AXIS_BACKWARD_SEGMENT];
    bool grows = p[AXIS_STATIC_LAW] != 0.0;
    if (p[AXIS_PARAMETERS + 2] > p[AXIS_STATIC_INITIAL] || back[2] > p[AXIS_BACKWARD_INITIAL]
        || (grows && p[AXIS_STATIC_INITIAL] > p[AXIS_STATIC_LIMIT])
        || (grows && p[AXIS_BACKWARD_INITIAL] > p[AXIS_BACKWARD_LIMIT])) {
        return refuse(i, "friction.static.initial has to be between kinetic friction at rest and friction.static.limit; "
                      "what was set before stays");
    }
    next.is_started = next.phase == NEW || next.phase == STARTING ? 0.0 : next.is_started;
    i->own = next;
    return fmi3OK;
}

static int do_step(Instance *i, double time, double step, bool *has_event, bool *is_early, double *reached)
{
    if (!is_in(i, STEP, "a step") || !obey(i)) {
        return fmi3Error;
    }
    double now = i->own.start + axis_time(i->axis), to = time + step - i->own.start, count = i->own.value[COUNT];
    if (!(fabs(time - now) <= 1e-12 * (1.0 + fabs(now)))) {
        return refuse(i, "a step from %.17g s: the FMU is at %.17g s, and steps follow each other", time, now);
    }
    if (!(step > 0.0 && to < 1e15)) {
        return refuse(i, "a step of %.17g s: it has to be above 0, and end before 1e15 s", step);
    }
    int code = AXIS_OK;
    bool has_one = to >= axis_time(i->axis);
    while (code == AXIS_OK && has_one) {
        code = noted(i, axis_advance_to_event(i->axis, floor(to), to - floor(to)));
        has_one = axis_event_count(i->axis) > 0;
        if (i->stops && has_one) {
            break;
        }
    }
    *reached = i->own.start + axis_time(i->axis);
    *is_early = i->stops && has_one && *reached < time + step;
    *has_event = i->has_event_mode && i->own.value[COUNT] > count;
    return done(i, code);
}

/* States */

static size_t state_size(Instance *i)
{
    return sizeof(Saved) + axis_state_size(i->axis) * sizeof(double);
}

static int tell_size(Instance *i, size_t *size)
{
    *size = state_size(i);
    return fmi3OK;
}

static uint64_t sum_of_state(Instance *i, const Saved *state)
{
    return sum_of(&state->own, state_size(i) - offsetof(Saved, own));
}

static int get_state(Instance *i, Saved **out)
{
    if (!obey(i)) {
        return fmi3Error;
    }
    Saved *state = *out != NULL ? *out : calloc(1, state_size(i));
    if (state == NULL || (*out != NULL && state->id != i->id)) {
        return refuse(i, state == NULL ? "there is no memory for a state" : "the state to write over is of another scene");
    }
    state->id = i->id;
    state->own = i->own;
    axis_get_state(i->axis, state->numbers);
    state->sum = sum_of_state(i, state);
    *out = state;
    return fmi3OK;
}

static int set_state(Instance *i, const Saved *state)
{
    if (state == NULL || state->id != i->id) {
        return refuse(i, "the state is of another scene: take one of an FMU of the same export");
    }
    int code;
    Instance next = *i;
    next.own = state->own;
    next.axis = started(&next, &code);
    if (code == AXIS_OK) {
        code = axis_set_state(next.axis, state->numbers, axis_state_size(next.axis));
    }
    axis_free(code == AXIS_OK ? i->axis : next.axis);
    if (code == AXIS_OK) {
        *i = next;
        i->own.phase = i->own.phase == EVENT && !i->has_event_mode ? STEP : i->own.phase;
    }
    return done(i, code);
}

static int free_state(void **state)
{
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

static int write_state(Instance *i, const Saved *state, void *out, size_t size)
{
    if (state == NULL || state->id != i->id || size != state_size(i)) {
        return refuse(i, "the state is of another scene, or has not this size");
    }
    memcpy(out, state, size);
    return fmi3OK;
}

static int read_state(Instance *i, const void *bytes, size_t size, void **out)
{
    Saved *state = size == state_size(i) ? malloc(size) : NULL;
    if (state != NULL) {
        memcpy(state, bytes, size);
    }
    if (state == NULL || state->id != i->id || state->sum != sum_of_state(i, state)) {
        free(state);
        return refuse(i, "the bytes are no state of this scene, or were changed");
    }
    *out = state;
    return fmi3OK;
}

/* The life of an instance */

static void free_instance(Instance *i)
{
    if (i != NULL) {
        axis_free(i->axis);
        free(i->numbers);
        free(i->scratch);
        free(i->rows);
        free(i);
    }
}

static Instance *instantiate(Instance given, const char *name, const char *token, const char *folder)
{
    int code;
    Instance *i = malloc(sizeof *i);
    if (i == NULL) {
        return NULL;
    }
    *i = given;
    snprintf(i->name, sizeof i->name, "%s", name == NULL ? "" : name);
    if (folder == NULL || token == NULL || !read_scene(i, folder, token) || !take_scene(i)
        || (i->axis = started(i, &code)) == NULL) {
        free_instance(i);
        return NULL;
    }
    return i;
}

static int go(Instance *i, int from, int to, const char *what)
{
    if (!is_in(i, from, what) || !obey(i)) {
        return fmi3Error;
    }
    i->own.phase = to;
    return fmi3OK;
}

static int begin(Instance *i, double start)
{
    if (!(fabs(start) < 1e15)) {
        return refuse(i, "a start at %g s: it has to be finite", start);
    }
    i->own.start = start;
    i->own.is_started = 0.0;
    return go(i, NEW, STARTING, "initialization");
}

static int reset(Instance *i)
{
    i->own = i->first;
    return fmi3OK;
}

static int absent(Instance *i, size_t n, const char *what)
{
    return n == 0 ? fmi3OK : refuse(i, "this FMU has no %s", what);
}

/* What both versions have */

#define BOTH(in_3, in_2, given, what) \
    EXPORT fmi3Status fmi3##in_3 given { return what; } \
    EXPORT fmi2Status fmi2##in_2 given { return what; }
BOTH(Reset, Reset, (void *c), reset(c))
BOTH(GetFMUState, GetFMUstate, (void *c, void **state), get_state(c, (Saved **)state))
BOTH(SetFMUState, SetFMUstate, (void *c, void *state), set_state(c, state))
BOTH(FreeFMUState, FreeFMUstate, (void *c, void **state), free_state(state))
BOTH(SerializedFMUStateSize, SerializedFMUstateSize, (void *c, void *state, size_t *size), tell_size(c, size))
EXPORT const char *fmi3GetVersion(void) { return "3.0"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT void fmi3FreeInstance(void *c) { free_instance(c); }
EXPORT void fmi2FreeInstance(void *c) { free_instance(c); }

#define GETTER(type, is_whole, count, head) EXPORT head \
{ \
    double value; \
    for (size_t k = 0; k < n; k++) { \
        if (count != n || !get(c, refs[k], is_whole, &value)) { \
            return 3; /* an error */ \
        } \
        out[k] = (type)value; \
    } \
    return 0; \
}
GETTER(double, false, m, fmi3Status fmi3GetFloat64(void *c, refs_3 refs, size_t n, double out[], size_t m))
GETTER(int64_t, true, m, fmi3Status fmi3GetInt64(void *c, refs_3 refs, size_t n, int64_t out[], size_t m))
GETTER(double, false, n, fmi2Status fmi2GetReal(void *c, refs_2 refs, size_t n, double out[]))
GETTER(int, true, n, fmi2Status fmi2GetInteger(void *c, refs_2 refs, size_t n, int out[]))

/* FMI 3.0 */

#define IN_3(name, given, what) EXPORT fmi3Status fmi3##name given { return what; }
IN_3(SetDebugLogging, (void *c, bool on, size_t n, const char *const categories[]), fmi3OK)
IN_3(EnterInitializationMode, (void *c, bool has_tolerance, double tolerance, double start, bool stops, double stop),
     begin(c, start))
IN_3(ExitInitializationMode, (void *c),
     go(c, STARTING, ((Instance *)c)->has_event_mode ? EVENT : STEP, "the end of initialization mode"))
IN_3(EnterEventMode, (void *c), ((Instance *)c)->has_event_mode ? go(c, STEP, EVENT, "event mode")
     : refuse(c, "event mode was not asked for: instantiate with eventModeUsed"))
IN_3(EnterStepMode, (void *c), go(c, EVENT, STEP, "step mode"))
IN_3(Terminate, (void *c), go(c, EVENT | STEP, ENDED, "the end"))
IN_3(EvaluateDiscreteStates, (void *c), is_in(c, EVENT | STARTING, "this") ? fmi3OK : fmi3Error)
IN_3(SetFloat64, (void *c, refs_3 refs, size_t n, const double values[], size_t m),
     m == n && is_in(c, ANY - ENDED, "a set value") ? set(c, refs, n, values) : fmi3Error)
IN_3(SerializeFMUState, (void *c, void *state, uint8_t out[], size_t size), write_state(c, state, out, size))
IN_3(DeserializeFMUState, (void *c, const uint8_t bytes[], size_t size, void **state), read_state(c, bytes, size, state))

EXPORT void *fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *folder, bool visible, bool logging, bool event_mode, bool early,
    const uint32_t wanted[], size_t count, void *environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback f)
{
    return instantiate((Instance){.environment = environment, .log_3 = log, .has_event_mode = event_mode, .stops = early},
                       name, token, folder);
}

EXPORT fmi3Status fmi3UpdateDiscreteStates(void *c, bool *again, bool *ends, bool *nominals, bool *values, bool *has_next,
                                           double *next)
{
    Instance *i = c;
    *again = *ends = *nominals = *values = *has_next = false;
    *next = 0.0;
    if (!is_in(i, EVENT, "an update of the discrete states") || !obey(i)) {
        return fmi3Error;
    }
    double now = axis_time(i->axis);
    int code = noted(i, axis_advance_to_event(i->axis, floor(now), now - floor(now)));   /* one more at the same instant */
    *again = axis_event_count(i->axis) > 0;
    return done(i, code);
}

EXPORT fmi3Status fmi3DoStep(void *c, double time, double step, bool no_state, bool *event, bool *ends, bool *early,
                             double *reached)
{
    *event = *ends = *early = false;
    *reached = time;
    return do_step(c, time, step, event, early, reached);
}

/* FMI 3.0 wants each function to be there, also of what an FMU has not. */

#define GET_ABSENT(kind, type) \
    EXPORT fmi3Status fmi3Get##kind(void *c, refs_3 r, size_t n, type v[], size_t m) \
    { return absent(c, n, "readable " #kind); }
#define SET_ABSENT(kind, type) \
    EXPORT fmi3Status fmi3Set##kind(void *c, refs_3 r, size_t n, const type v[], size_t m) \
    { return absent(c, n, "settable " #kind); }
#define ABSENT(kind, type) GET_ABSENT(kind, type) SET_ABSENT(kind, type)
typedef const char *text;
ABSENT(Float32, float) ABSENT(Boolean, bool) ABSENT(String, text)
ABSENT(Int8, int8_t) ABSENT(Int16, int16_t) ABSENT(Int32, int32_t) SET_ABSENT(Int64, int64_t)
ABSENT(UInt8, uint8_t) ABSENT(UInt16, uint16_t) ABSENT(UInt32, uint32_t) ABSENT(UInt64, uint64_t)
#define ABSENT_FUNCTION(name, ...) IN_3(name, (void *c, __VA_ARGS__), absent(c, 1, #name))
typedef const uint8_t *binary;
ABSENT_FUNCTION(GetBinary, refs_3 r, size_t n, size_t s[], binary v[], size_t m)
ABSENT_FUNCTION(SetBinary, refs_3 r, size_t n, const size_t s[], const binary v[], size_t m)
ABSENT_FUNCTION(GetClock, refs_3 r, size_t n, bool v[])
ABSENT_FUNCTION(SetClock, refs_3 r, size_t n, const bool v[])
ABSENT_FUNCTION(GetNumberOfVariableDependencies, uint32_t r, size_t *n)
ABSENT_FUNCTION(GetVariableDependencies, uint32_t r, size_t e[], uint32_t o[], size_t f[], fmi3DependencyKind k[], size_t n)
ABSENT_FUNCTION(GetDirectionalDerivative, refs_3 r, size_t n, refs_3 k, size_t l, const double s[], size_t o, double v[], size_t m)
ABSENT_FUNCTION(GetAdjointDerivative, refs_3 r, size_t n, refs_3 k, size_t l, const double s[], size_t o, double v[], size_t m)
ABSENT_FUNCTION(GetIntervalDecimal, refs_3 r, size_t n, double v[], fmi3IntervalQualifier q[])
ABSENT_FUNCTION(GetIntervalFraction, refs_3 r, size_t n, uint64_t v[], uint64_t s[], fmi3IntervalQualifier q[])
ABSENT_FUNCTION(GetShiftDecimal, refs_3 r, size_t n, double v[])
ABSENT_FUNCTION(GetShiftFraction, refs_3 r, size_t n, uint64_t v[], uint64_t s[])
ABSENT_FUNCTION(SetIntervalDecimal, refs_3 r, size_t n, const double v[])
ABSENT_FUNCTION(SetIntervalFraction, refs_3 r, size_t n, const uint64_t v[], const uint64_t s[])
ABSENT_FUNCTION(SetShiftDecimal, refs_3 r, size_t n, const double v[])
ABSENT_FUNCTION(SetShiftFraction, refs_3 r, size_t n, const uint64_t v[], const uint64_t s[])
ABSENT_FUNCTION(GetOutputDerivatives, refs_3 r, size_t n, const int32_t o[], double v[], size_t m)
ABSENT_FUNCTION(ActivateModelPartition, uint32_t r, double t)
ABSENT_FUNCTION(CompletedIntegratorStep, bool no_state, bool *event, bool *ends)
ABSENT_FUNCTION(SetTime, double t)
ABSENT_FUNCTION(SetContinuousStates, const double v[], size_t n)
ABSENT_FUNCTION(GetContinuousStateDerivatives, double v[], size_t n)
ABSENT_FUNCTION(GetEventIndicators, double v[], size_t n)
ABSENT_FUNCTION(GetContinuousStates, double v[], size_t n)
ABSENT_FUNCTION(GetNominalsOfContinuousStates, double v[], size_t n)
ABSENT_FUNCTION(GetNumberOfEventIndicators, size_t *n)
ABSENT_FUNCTION(GetNumberOfContinuousStates, size_t *n)
IN_3(EnterContinuousTimeMode, (void *c), absent(c, 1, "model exchange"))
IN_3(EnterConfigurationMode, (void *c), absent(c, 1, "structural parameters"))
IN_3(ExitConfigurationMode, (void *c), absent(c, 1, "structural parameters"))

EXPORT void *fmi3InstantiateModelExchange(const char *n, const char *t, const char *f, bool v, bool l, void *e,
                                          fmi3LogMessageCallback log)
{
    return refuse(&(Instance){.environment = e, .log_3 = log}, "this FMU is for co-simulation alone"), NULL;
}

EXPORT void *fmi3InstantiateScheduledExecution(
    const char *n, const char *t, const char *f, bool v, bool l, void *e, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback clock, fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock)
{
    return fmi3InstantiateModelExchange(n, t, f, v, l, e, log);
}

/* FMI 2.0 */

#define IN_2(name, given, what) EXPORT fmi2Status fmi2##name given { return what; }
IN_2(SetDebugLogging, (void *c, int on, size_t n, const char *const categories[]), fmi2OK)
IN_2(EnterInitializationMode, (void *c), begin(c, ((Instance *)c)->own.start))
IN_2(ExitInitializationMode, (void *c), go(c, STARTING, STEP, "the end of initialization mode"))
IN_2(Terminate, (void *c), go(c, STEP, ENDED, "the end"))
IN_2(SetReal, (void *c, refs_2 r, size_t n, const double v[]), (fmi2Status)fmi3SetFloat64(c, r, n, v, n))
IN_2(SerializeFMUstate, (void *c, void *state, char out[], size_t size), write_state(c, state, out, size))
IN_2(DeSerializeFMUstate, (void *c, const char bytes[], size_t size, void **state), read_state(c, bytes, size, state))
IN_2(CancelStep, (void *c), absent(c, 1, "steps in the background"))

EXPORT void *fmi2Instantiate(const char *name, fmi2Type type, const char *token, const char *folder,
                             const fmi2CallbackFunctions *functions, int visible, int logging)
{
    Instance given = {.functions_2 = functions, .environment = functions == NULL ? NULL : functions->componentEnvironment};
    return type == fmi2CoSimulation ? instantiate(given, name, token, folder)
        : (refuse(&given, "this FMU is for co-simulation alone"), NULL);
}

EXPORT fmi2Status fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int stops, double stop)
{
    return is_in(c, NEW, "the set-up") && fabs(start) < 1e15 ? ((Instance *)c)->own.start = start, fmi2OK
        : (fmi2Status)refuse(c, "a start at %g s: it has to be finite, and come first", start);
}

EXPORT fmi2Status fmi2DoStep(void *c, double time, double step, int no_state)
{
    bool has_event, is_early;
    double reached;
    return do_step(c, time, step, &has_event, &is_early, &reached);
}

#define ABSENT_2(name, ...) IN_2(name, (void *c, __VA_ARGS__), absent(c, 1, #name))
ABSENT_2(SetInteger, refs_2 r, size_t n, const int v[])
ABSENT_2(GetBoolean, refs_2 r, size_t n, int v[])
ABSENT_2(SetBoolean, refs_2 r, size_t n, const int v[])
ABSENT_2(GetString, refs_2 r, size_t n, text v[])
ABSENT_2(SetString, refs_2 r, size_t n, const text v[])
ABSENT_2(GetDirectionalDerivative, refs_2 r, size_t n, refs_2 k, size_t m, const double s[], double v[])
ABSENT_2(SetRealInputDerivatives, refs_2 r, size_t n, const int o[], const double v[])
ABSENT_2(GetRealOutputDerivatives, refs_2 r, size_t n, const int o[], double v[])
ABSENT_2(GetStatus, fmi2StatusKind s, fmi2Status *v)
ABSENT_2(GetRealStatus, fmi2StatusKind s, double *v)
ABSENT_2(GetIntegerStatus, fmi2StatusKind s, int *v)
ABSENT_2(GetBooleanStatus, fmi2StatusKind s, int *v)
ABSENT_2(GetStringStatus, fmi2StatusKind s, text *v)
