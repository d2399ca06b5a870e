/* Copyright 2026 The stickslip authors
   SPDX-License-Identifier: Apache-2.0

   An axis as an FMU for co-simulation, FMI 3.0 and 2.0, on what stickslip_axis.h promises.  The scene is read from
   resources/axis.txt.  FMI's types are declared here as far as they are used; -DSTICKSLIP_FMI_HEADERS takes the official
   headers instead, which so check each function. */

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stickslip_axis.h"

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

#define FIRST_SUM 14695981039346656037u   /* FNV-1a */
#define SUM_FACTOR 1099511628211u

typedef const uint32_t refs_3[];
typedef const unsigned refs_2[];

enum { NEW = 1, STARTING = 2, EVENT = 4, STEP = 8, ENDED = 16, ANY = 31 };
enum { COMMANDS = 3, MOST_TUNED = 16, HEAD = 7, TUNED_ROW = 4, START = 5, MODE = 2 };
/* the value references */
enum { TIME = 0, FIRST_COMMAND = 1, FIRST_OUTPUT = 10, LAST_OUTPUT = 22, COUNT = 30, EVENT_TIME = 31, KIND = 32, FIRST_TUNED = 40 };

/* What belongs to a state beside the numbers of the axis. */
typedef struct {
    double phase, is_started, has_new_inputs, has_new_parameters, start, event_count, event_time, event_kind;
    double is_commanded[COMMANDS], command[COMMANDS], tuned[MOST_TUNED];
} Own;

typedef struct {
    Own own, first;                    /* now, and before anything was set */
    axis *axis;
    uint64_t id;                       /* of the scene */
    double *numbers, *parameters, *tuned_rows, *sinusoids, *scratch;
    size_t count, parameter_count, tuned_count, sinusoid_count, command_count;
    axis_inputs inputs;                /* of the scene */
    axis_start_state initial;
    axis_sinusoid *rows;
    bool has_event_mode, stops, has_sample;
    axis_sample_row sample;
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

/* The scene */

static bool read_numbers(Instance *i, const char *folder, const char *token)
{
    char path[4096], known[128] = "", *out = path;
    bool is_uri = strncmp(folder, "file:", 5) == 0;
    folder += is_uri ? 5 : 0;
    folder += is_uri && strncmp(folder, "//", 2) == 0 ? 2 : 0;
    for (unsigned code; *folder != 0 && out < path + sizeof path - 16; folder++) {
        bool is_coded = is_uri && sscanf(folder, "%%%2x", &code) == 1;
        *out++ = is_coded ? (char)code : *folder;
        folder += is_coded ? 2 : 0;
    }
    strcpy(out, "/axis.txt");
    FILE *file = fopen(path, "r");
    if (file == NULL || fscanf(file, "%127s %zu", known, &i->count) != 2 || i->count > 10000000
        || strcmp(known, token) != 0 || (i->numbers = calloc(i->count + 1, sizeof(double))) == NULL) {
        refuse(i, file == NULL ? "%s cannot be opened: unpack the FMU whole" : known[0] == 0 ? "%s is no scene"
               : "%s is not of this instantiation token: take the one of modelDescription.xml", path);
        if (file != NULL) {
            fclose(file);
        }
        return false;
    }
    i->id = FIRST_SUM;
    size_t read = 0;
    for (uint64_t bits; read < i->count && fscanf(file, "%" SCNx64, &bits) == 1; read++) {
        memcpy(&i->numbers[read], &bits, sizeof bits);
        i->id = (i->id ^ bits) * SUM_FACTOR;
    }
    fclose(file);
    return read == i->count || refuse(i, "%s ends early: unpack the FMU again", path) == fmi3OK;
}

static axis_profile profile_at(double **at, double count)
{
    size_t n = (size_t)count;
    axis_profile of = {.count = n, .period = (*at)[0], .starts = *at + 1, .values = *at + 1 + n, .rates = *at + 1 + 2 * n};
    *at += 1 + 3 * n;
    return of;
}

static bool take_scene(Instance *i)
{
    const double *n = i->numbers;
    double whole = HEAD + START + 2 * COMMANDS;
    for (size_t k = 0; i->count > HEAD && k < HEAD; k++) {
        static const double sizes[HEAD] = {1, TUNED_ROW + 1, 5, 0, 3, 3, 3};
        whole += n[k] >= 0.0 && n[k] < 1e7 && n[k] == floor(n[k]) ? sizes[k] * n[k] : INFINITY;
    }
    if (i->count <= HEAD || whole != (double)i->count || n[1] > MOST_TUNED) {
        return false;
    }
    i->parameter_count = (size_t)n[0];
    i->tuned_count = (size_t)n[1];
    i->sinusoid_count = (size_t)n[2];
    double *at = i->numbers + HEAD;
    i->parameters = at;
    i->tuned_rows = at + i->parameter_count;
    for (size_t k = 0; k < i->tuned_count; k++) {
        double field = i->tuned_rows[k * TUNED_ROW], other = i->tuned_rows[k * TUNED_ROW + 1];
        if (!(field >= 0.0 && field <= AXIS_PARAMETERS && other >= 0.0 && other < AXIS_PARAMETERS)
            || i->parameter_count <= AXIS_PARAMETERS) {
            return false;
        }
    }
    at = i->tuned_rows + i->tuned_count * TUNED_ROW;
    i->first.phase = NEW;
    memcpy(i->first.tuned, at, i->tuned_count * sizeof(double));
    at += i->tuned_count;
    i->initial = (axis_start_state){at[0], at[1], at[2], at[3], at[4]};
    memcpy(i->first.command, at + START, sizeof i->first.command);
    at += START + COMMANDS;
    i->sinusoids = at;
    at += 5 * i->sinusoid_count;
    i->inputs.normal_varies = n[3] != 0.0;
    i->command_count = i->inputs.normal_varies ? COMMANDS : COMMANDS - 1;
    i->inputs.drive = profile_at(&at, n[4]);
    i->inputs.force = profile_at(&at, n[5]);
    i->inputs.normal = profile_at(&at, n[6]);
    i->scratch = calloc(i->parameter_count + 1, sizeof(double));
    i->rows = calloc(i->sinusoid_count + 1, sizeof *i->rows);
    return i->scratch != NULL && i->rows != NULL;
}

/* The axis */

static void note_events(Instance *i)
{
    for (size_t k = 0; k < axis_event_count(i->axis); k++) {
        axis_event event = axis_event_at(i->axis, k);
        i->own.event_count++;
        i->own.event_time = i->own.start + (event.second + event.fraction);
        i->own.event_kind = event.kind;
    }
    i->has_sample = false;
}

/* The parameters as they are tuned; a factor on all friction stands behind their fields. */
static const double *tuned_parameters(Instance *i, const double *tuned)
{
    double *p = i->scratch;
    memcpy(p, i->parameters, i->parameter_count * sizeof(double));
    for (size_t k = 0; k < i->tuned_count; k++) {
        const double *row = i->tuned_rows + k * TUNED_ROW, start = i->first.tuned[k];
        if (row[0] < AXIS_PARAMETERS && tuned[k] != start) {
            p[(size_t)row[0]] = p[(size_t)row[1]] = tuned[k];
        } else if (tuned[k] != start) {
            static const int scaled[] = {AXIS_STATIC_INITIAL, AXIS_STATIC_LIMIT, AXIS_BACKWARD_INITIAL,
                                         AXIS_BACKWARD_LIMIT, AXIS_END_SLOPE};
            for (size_t j = 0; j < sizeof scaled / sizeof *scaled; j++) {
                p[scaled[j]] *= tuned[k] / start;
            }
            for (size_t j = AXIS_PARAMETERS; j + 6 <= i->parameter_count; j += 6) {
                p[j + 2] *= tuned[k] / start;    /* mu_k, and its slope */
                p[j + 4] *= tuned[k] / start;
            }
        }
    }
    return p;
}

static axis_inputs inputs_in_force(Instance *i)
{
    const double *is = i->own.is_commanded;
    axis_inputs inputs = i->inputs;
    axis_profile *profiles[COMMANDS] = {&inputs.drive, &inputs.force, &inputs.normal};
    for (size_t k = 0; k < COMMANDS; k++) {
        if (is[k] != 0.0) {
            *profiles[k] = (axis_profile){.value = i->own.command[k]};
        }
    }
    for (size_t k = 0; k < i->sinusoid_count; k++) {    /* those of inputs that are not commanded */
        const double *n = i->sinusoids + 5 * k;
        if (!((n[2] != 0.0 && is[0] != 0.0) || (n[3] != 0.0 && is[1] != 0.0) || (n[4] != 0.0 && is[2] != 0.0))) {
            i->rows[inputs.sinusoid_count++] = (axis_sinusoid){n[0], n[1], n[2], n[3], n[4]};
        }
    }
    inputs.sinusoids = i->rows;
    return inputs;
}

static int start_axis(Instance *i)
{
    int code;
    axis_inputs inputs = inputs_in_force(i);
    axis *made = axis_new(tuned_parameters(i, i->own.tuned), i->parameter_count, i->sinusoid_count, 4, false, &code);
    if (made != NULL && (code = axis_start(made, &i->initial, &inputs)) != AXIS_OK) {
        axis_free(made);
    }
    if (code == AXIS_OK) {
        axis_free(i->axis);
        i->axis = made;
    }
    return code;
}

/* Let what was set act from the present time on, before anything is read or goes on. */
static bool obey(Instance *i)
{
    int code = AXIS_OK;
    if (i->own.is_started == 0.0) {
        code = start_axis(i);
        i->own.is_started = code == AXIS_OK;
        i->own.event_count = i->own.event_time = i->own.has_new_inputs = i->own.has_new_parameters = 0.0;
        i->own.event_kind = -1.0;
        if (code == AXIS_OK) {
            note_events(i);
        }
    }
    if (code == AXIS_OK && i->own.has_new_inputs != 0.0) {
        axis_inputs inputs = inputs_in_force(i);
        code = axis_set_inputs(i->axis, &inputs);
        i->own.has_new_inputs = 0.0;
        note_events(i);
    }
    if (code == AXIS_OK && i->own.has_new_parameters != 0.0) {
        code = axis_set_parameters(i->axis, tuned_parameters(i, i->own.tuned), i->parameter_count);
        i->own.has_new_parameters = 0.0;
        note_events(i);
    }
    return code == AXIS_OK || refuse(i, "%s", axis_text(code)) == fmi3OK;
}

/* Values */

static bool get(Instance *i, unsigned ref, bool whole, double *out)
{
    size_t tuned = ref - FIRST_TUNED, command = ref - FIRST_COMMAND, output = ref - FIRST_OUTPUT;
    bool is_output = output <= LAST_OUTPUT - FIRST_OUTPUT, is_event = ref >= COUNT && ref <= KIND;
    if (whole != (ref == COUNT || ref == KIND || output < 2)
        || !(ref == TIME || command < i->command_count || is_output || is_event || tuned < i->tuned_count)) {
        return refuse(i, "value reference %u is no %s of this FMU: take those of modelDescription.xml", ref,
                      whole ? "whole number" : "real number") == fmi3OK;
    }
    if (command < COMMANDS || tuned < i->tuned_count) {
        *out = tuned < i->tuned_count ? i->own.tuned[tuned] : i->own.command[command];
        return true;
    }
    if (!obey(i)) {
        return false;
    }
    if (is_output && !i->has_sample) {
        int code = axis_sample(i->axis, &i->sample);
        i->has_sample = code == AXIS_OK || refuse(i, "%s", axis_text(code)) == fmi3OK;
    }
    *out = is_output ? ((const double *)&i->sample)[MODE + output] : ref == TIME ? i->own.start + axis_time(i->axis)
        : ref == COUNT ? i->own.event_count : ref == EVENT_TIME ? i->own.event_time : i->own.event_kind;
    return !is_output || i->has_sample;
}

/* Take all values or, where one is wrong, none. */
static int set(Instance *i, const uint32_t *refs, size_t n, const double *values)
{
    Own next = i->own;
    for (size_t k = 0; k < n; k++) {
        size_t tuned = refs[k] - FIRST_TUNED, command = refs[k] - FIRST_COMMAND;
        bool is_command = command < i->command_count;
        if (!is_command && tuned >= i->tuned_count) {
            return refuse(i, "value reference %u cannot be set: only inputs and parameters can", (unsigned)refs[k]);
        }
        const double *row = i->tuned_rows + TUNED_ROW * (is_command ? 0 : tuned);
        double low = is_command ? command == 2 ? 0.0 : -1e15 : row[2], high = is_command ? 1e15 : row[3];
        if (!(values[k] >= low && values[k] <= high)) {
            return refuse(i, "value reference %u is set to %g: allowed is %g to %g; what was set before stays",
                          (unsigned)refs[k], values[k], low, high);
        }
        double *to = is_command ? &next.command[command] : &next.tuned[tuned], value = values[k] + 0.0;
        if (!is_command && *to != value) {
            next.has_new_parameters = 1.0;
        }
        if (is_command && (*to != value || next.is_commanded[command] == 0.0)) {
            next.has_new_inputs = next.is_commanded[command] = 1.0;
        }
        *to = value;
    }
    const double *p = tuned_parameters(i, next.tuned), *back = p + AXIS_PARAMETERS + 6 * (size_t)p[AXIS_BACKWARD_SEGMENT];
    bool grows = p[AXIS_STATIC_LAW] != 0.0;
    if (p[AXIS_PARAMETERS + 2] > p[AXIS_STATIC_INITIAL] || back[2] > p[AXIS_BACKWARD_INITIAL]
        || (grows && p[AXIS_STATIC_INITIAL] > p[AXIS_STATIC_LIMIT])
        || (grows && p[AXIS_BACKWARD_INITIAL] > p[AXIS_BACKWARD_LIMIT])) {
        return refuse(i, "friction.static.initial has to be between kinetic friction at rest and friction.static.limit; "
                      "what was set before stays");
    }
    next.is_started = next.phase == NEW || next.phase == STARTING ? 0.0 : next.is_started;
    i->has_sample = i->has_sample && next.is_started != 0.0 && next.has_new_inputs + next.has_new_parameters == 0.0;
    i->own = next;
    return fmi3OK;
}

static int do_step(Instance *i, double time, double step, bool *has_event, bool *is_early, double *reached)
{
    if (!is_in(i, STEP, "a step") || !obey(i)) {
        return fmi3Error;
    }
    double now = i->own.start + axis_time(i->axis), to = time + step - i->own.start, count = i->own.event_count;
    if (!(fabs(time - now) <= 1e-12 * (1.0 + fabs(now)))) {
        return refuse(i, "a step from %.17g s: the FMU is at %.17g s, and steps follow each other", time, now);
    }
    if (!(step > 0.0 && to < 1e15)) {
        return refuse(i, "a step of %.17g s: it has to be above 0, and end before 1e15 s", step);
    }
    int code = AXIS_OK;
    bool has_one = to >= axis_time(i->axis);
    while (code == AXIS_OK && has_one) {
        code = axis_advance_to_event(i->axis, floor(to), to - floor(to));
        note_events(i);
        has_one = axis_event_count(i->axis) > 0;
        if (i->stops && has_one) {
            break;
        }
    }
    *reached = i->own.start + axis_time(i->axis);
    *is_early = i->stops && has_one && *reached < time + step;
    *has_event = i->has_event_mode && i->own.event_count > count;
    return code == AXIS_OK ? fmi3OK : refuse(i, "at %.17g s: %s", *reached, axis_text(code));
}

/* States: the scene, a sum of what follows, what is beside the axis, the numbers of the axis */

enum { OWN = 2, NUMBERS = OWN + sizeof(Own) / sizeof(uint64_t) };

static size_t state_size(Instance *i)
{
    return (NUMBERS + axis_state_size(i->axis)) * sizeof(uint64_t);
}

static uint64_t sum_of(const uint64_t *state, size_t size)
{
    uint64_t sum = FIRST_SUM;
    for (size_t k = OWN; k < size / sizeof *state; k++) {
        sum = (sum ^ state[k]) * SUM_FACTOR;
    }
    return sum;
}

static int get_state(Instance *i, void **out)
{
    if (!obey(i)) {
        return fmi3Error;
    }
    uint64_t *state = *out != NULL ? *out : calloc(1, state_size(i));
    if (state == NULL || (*out != NULL && state[0] != i->id)) {
        return refuse(i, state == NULL ? "there is no memory for a state" : "the state to write over is of another scene");
    }
    state[0] = i->id;
    memcpy(state + OWN, &i->own, sizeof(Own));
    axis_get_state(i->axis, (double *)(state + NUMBERS));
    state[1] = sum_of(state, state_size(i));
    *out = state;
    return fmi3OK;
}

static int set_state(Instance *i, const uint64_t *state)
{
    if (state == NULL || state[0] != i->id) {
        return refuse(i, "the state is of another scene: take one of an FMU of the same export");
    }
    Own before = i->own;
    axis *axis_before = i->axis;
    i->axis = NULL;
    memcpy(&i->own, state + OWN, sizeof(Own));
    int code = start_axis(i);
    if (code == AXIS_OK) {
        code = axis_set_state(i->axis, (const double *)(state + NUMBERS), axis_state_size(i->axis));
    }
    axis_free(code == AXIS_OK ? axis_before : i->axis);
    if (code != AXIS_OK) {
        i->axis = axis_before;
        i->own = before;
        return refuse(i, "%s", axis_text(code));
    }
    if (i->own.phase == EVENT && !i->has_event_mode) {
        i->own.phase = STEP;
    }
    i->has_sample = false;
    return fmi3OK;
}

static int free_state(void **state)
{
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

static int write_state(Instance *i, const uint64_t *state, void *out, size_t size)
{
    if (state == NULL || state[0] != i->id || size != state_size(i)) {
        return refuse(i, "the state is of another scene, or has not this size");
    }
    memcpy(out, state, size);
    return fmi3OK;
}

static int read_state(Instance *i, const void *bytes, size_t size, void **out)
{
    uint64_t *state = size == state_size(i) ? malloc(size) : NULL;
    if (state != NULL) {
        memcpy(state, bytes, size);
    }
    if (state == NULL || state[0] != i->id || state[1] != sum_of(state, size)) {
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
    Instance *i = malloc(sizeof *i);
    if (i == NULL) {
        return NULL;
    }
    *i = given;
    snprintf(i->name, sizeof i->name, "%s", name == NULL ? "" : name);
    if (folder == NULL || token == NULL || !read_numbers(i, folder, token)) {
        free_instance(i);
        return NULL;
    }
    bool is_whole = take_scene(i);
    i->own = i->first;
    if (!is_whole || start_axis(i) != AXIS_OK) {
        refuse(i, "resources/axis.txt is damaged: unpack the FMU again");
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
    i->has_sample = false;
    return fmi3OK;
}

static int absent(Instance *i, size_t n, const char *what)
{
    return n == 0 ? fmi3OK : refuse(i, "this FMU has no %s", what);
}

/* FMI 3.0 */

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT void *fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *folder, bool visible, bool logging, bool event_mode, bool early,
    const uint32_t wanted[], size_t count, void *environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback f)
{
    (void)visible, (void)logging, (void)wanted, (void)count, (void)f;
    return instantiate((Instance){.environment = environment, .log_3 = log, .has_event_mode = event_mode, .stops = early},
                       name, token, folder);
}

EXPORT void fmi3FreeInstance(void *c) { free_instance(c); }

EXPORT fmi3Status fmi3SetDebugLogging(void *c, bool on, size_t n, const char *const categories[])
{
    return (void)c, (void)on, (void)n, (void)categories, fmi3OK;
}

EXPORT fmi3Status fmi3EnterInitializationMode(void *c, bool has_tolerance, double tolerance, double start, bool stops,
                                              double stop)
{
    return (void)has_tolerance, (void)tolerance, (void)stops, (void)stop, begin(c, start);
}

EXPORT fmi3Status fmi3ExitInitializationMode(void *c)
{
    return go(c, STARTING, ((Instance *)c)->has_event_mode ? EVENT : STEP, "the end of initialization mode");
}

EXPORT fmi3Status fmi3EnterEventMode(void *c)
{
    return ((Instance *)c)->has_event_mode ? go(c, STEP, EVENT, "event mode")
        : refuse(c, "event mode was not asked for: instantiate with eventModeUsed") ;
}

EXPORT fmi3Status fmi3EnterStepMode(void *c) { return go(c, EVENT, STEP, "step mode"); }
EXPORT fmi3Status fmi3Terminate(void *c) { return go(c, EVENT | STEP, ENDED, "the end"); }
EXPORT fmi3Status fmi3Reset(void *c) { return reset(c); }

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
    int code = axis_advance_to_event(i->axis, floor(now), now - floor(now));   /* one more at the same instant */
    note_events(i);
    *again = axis_event_count(i->axis) > 0;
    return code == AXIS_OK ? fmi3OK : refuse(i, "%s", axis_text(code));
}

EXPORT fmi3Status fmi3DoStep(void *c, double time, double step, bool no_state, bool *event, bool *ends, bool *early,
                             double *reached)
{
    (void)no_state;
    *event = *ends = *early = false;
    *reached = time;
    return do_step(c, time, step, event, early, reached);
}

EXPORT fmi3Status fmi3GetFloat64(void *c, refs_3 refs, size_t n, double out[], size_t m)
{
    for (size_t k = 0; k < n; k++) {
        if (m != n || !get(c, refs[k], false, &out[k])) {
            return fmi3Error;
        }
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3GetInt64(void *c, refs_3 refs, size_t n, int64_t out[], size_t m)
{
    double value;
    for (size_t k = 0; k < n; k++) {
        if (m != n || !get(c, refs[k], true, &value)) {
            return fmi3Error;
        }
        out[k] = (int64_t)value;
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetFloat64(void *c, refs_3 refs, size_t n, const double values[], size_t m)
{
    return m == n && is_in(c, ANY - ENDED, "a set value") ? set(c, refs, n, values) : fmi3Error;
}

EXPORT fmi3Status fmi3GetFMUState(void *c, void **state) { return get_state(c, state); }
EXPORT fmi3Status fmi3SetFMUState(void *c, void *state) { return set_state(c, state); }
EXPORT fmi3Status fmi3FreeFMUState(void *c, void **state) { return (void)c, free_state(state); }

EXPORT fmi3Status fmi3SerializedFMUStateSize(void *c, void *state, size_t *size)
{
    return (void)state, *size = state_size(c), fmi3OK;
}

EXPORT fmi3Status fmi3SerializeFMUState(void *c, void *state, uint8_t out[], size_t size)
{
    return write_state(c, state, out, size);
}

EXPORT fmi3Status fmi3DeserializeFMUState(void *c, const uint8_t bytes[], size_t size, void **state)
{
    return read_state(c, bytes, size, state);
}

/* FMI 3.0 wants each function to be there, also of what an FMU has not. */

#define GET_ABSENT(kind, type) \
    EXPORT fmi3Status fmi3Get##kind(void *c, refs_3 r, size_t n, type v[], size_t m) \
    { return (void)r, (void)v, (void)m, absent(c, n, "readable " #kind); }
#define SET_ABSENT(kind, type) \
    EXPORT fmi3Status fmi3Set##kind(void *c, refs_3 r, size_t n, const type v[], size_t m) \
    { return (void)r, (void)v, (void)m, absent(c, n, "settable " #kind); }
#define ABSENT(kind, type) GET_ABSENT(kind, type) SET_ABSENT(kind, type)
ABSENT(Float32, float)
ABSENT(Int8, int8_t)
ABSENT(UInt8, uint8_t)
ABSENT(Int16, int16_t)
ABSENT(UInt16, uint16_t)
ABSENT(Int32, int32_t)
ABSENT(UInt32, uint32_t)
SET_ABSENT(Int64, int64_t)
ABSENT(UInt64, uint64_t)
ABSENT(Boolean, bool)
typedef const char *text;
ABSENT(String, text)
#define ABSENT_FUNCTION(name, ...) \
    EXPORT fmi3Status fmi3##name(void *c, __VA_ARGS__) { return absent(c, 1, #name); }
#pragma GCC diagnostic ignored "-Wunused-parameter"
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
EXPORT fmi3Status fmi3EnterContinuousTimeMode(void *c) { return absent(c, 1, "model exchange"); }
EXPORT fmi3Status fmi3EnterConfigurationMode(void *c) { return absent(c, 1, "structural parameters"); }
EXPORT fmi3Status fmi3ExitConfigurationMode(void *c) { return absent(c, 1, "structural parameters"); }
EXPORT fmi3Status fmi3EvaluateDiscreteStates(void *c) { return is_in(c, EVENT | STARTING, "this") ? fmi3OK : fmi3Error; }

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

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT void *fmi2Instantiate(const char *name, fmi2Type type, const char *token, const char *folder,
                             const fmi2CallbackFunctions *functions, int visible, int logging)
{
    Instance given = {.functions_2 = functions, .environment = functions == NULL ? NULL : functions->componentEnvironment};
    return type == fmi2CoSimulation ? instantiate(given, name, token, folder)
        : (refuse(&given, "this FMU is for co-simulation alone"), NULL);
}

EXPORT void fmi2FreeInstance(void *c) { free_instance(c); }
EXPORT fmi2Status fmi2SetDebugLogging(void *c, int on, size_t n, const char *const categories[]) { return fmi2OK; }

EXPORT fmi2Status fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int stops, double stop)
{
    return is_in(c, NEW, "the set-up") && fabs(start) < 1e15 ? ((Instance *)c)->own.start = start, fmi2OK
        : (fmi2Status)refuse(c, "a start at %g s: it has to be finite, and come first", start);
}

EXPORT fmi2Status fmi2EnterInitializationMode(void *c) { return begin(c, ((Instance *)c)->own.start); }
EXPORT fmi2Status fmi2ExitInitializationMode(void *c) { return go(c, STARTING, STEP, "the end of initialization mode"); }
EXPORT fmi2Status fmi2Terminate(void *c) { return go(c, STEP, ENDED, "the end"); }
EXPORT fmi2Status fmi2Reset(void *c) { return reset(c); }

EXPORT fmi2Status fmi2GetReal(void *c, refs_2 refs, size_t n, double out[]) { return (fmi2Status)fmi3GetFloat64(c, refs, n, out, n); }
EXPORT fmi2Status fmi2SetReal(void *c, refs_2 r, size_t n, const double v[]) { return (fmi2Status)fmi3SetFloat64(c, r, n, v, n); }

EXPORT fmi2Status fmi2GetInteger(void *c, refs_2 refs, size_t n, int out[])
{
    double value;
    for (size_t k = 0; k < n; k++) {
        if (!get(c, refs[k], true, &value)) {
            return fmi2Error;
        }
        out[k] = (int)value;
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2DoStep(void *c, double time, double step, int no_state)
{
    bool has_event, is_early;
    double reached;
    return do_step(c, time, step, &has_event, &is_early, &reached);
}

EXPORT fmi2Status fmi2GetFMUstate(void *c, void **state) { return get_state(c, state); }
EXPORT fmi2Status fmi2SetFMUstate(void *c, void *state) { return set_state(c, state); }
EXPORT fmi2Status fmi2FreeFMUstate(void *c, void **state) { return free_state(state); }
EXPORT fmi2Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *n) { return *n = state_size(c), fmi2OK; }
EXPORT fmi2Status fmi2SerializeFMUstate(void *c, void *s, char out[], size_t n) { return write_state(c, s, out, n); }
EXPORT fmi2Status fmi2DeSerializeFMUstate(void *c, const char in[], size_t n, void **s) { return read_state(c, in, n, s); }

#define ABSENT_2(name, ...) EXPORT fmi2Status fmi2##name(void *c, __VA_ARGS__) { return absent(c, 1, #name); }
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
EXPORT fmi2Status fmi2CancelStep(void *c) { return absent(c, 1, "steps in the background"); }
