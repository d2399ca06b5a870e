
/* What stickslip_axis.h promises: records of the engine above in one piece of memory, and checks of what is given. */

#include <stddef.h>
#include <stdlib.h>

#include "stickslip_axis.h"

enum {
    AXIS_STATE = offsetof(State, sinusoids) / sizeof(double), AXIS_SEGMENT = sizeof(Segment) / sizeof(double),
    AXIS_SINUSOID = sizeof(SinusoidRecord) / sizeof(double), AXIS_OWN = 5,
    AXIS_MOST_AT_ONCE = 100000    /* events within so many seconds that time is said not to go on: */
};
#define AXIS_AT_ONCE 0.01
_Static_assert(offsetof(Parameters, segments) == AXIS_PARAMETERS * sizeof(double), "parameters");
_Static_assert(sizeof(axis_event) == sizeof(EventRow) && sizeof(axis_sample_row) == sizeof(SampleRow)
               && sizeof(axis_energy_row) == sizeof(EnergyRow) && sizeof(axis_sinusoid) == sizeof(GivenSinusoid), "rows");

enum { AXIS_DRIVE, AXIS_FORCE, AXIS_NORMAL, AXIS_INPUTS };

struct axis {
    Parameters parameters, next;
    State state;
    Events events;
    Sinusoids sinusoids;
    Pieces pieces[AXIS_INPUTS];
    double one_piece[AXIS_INPUTS][3];     /* start, value and rate of an input without arrays */
    Double3 now[AXIS_INPUTS];             /* value, rate and end of each where it was read last */
    SeriesScratch scratch[state_record_HIGHEST_ORDER + 1];
    axis_inputs inputs;
    double second, fraction, until, constant_normal_force;
    size_t segments, most;
    long rows, crowd;                /* events since time last went on, and where that was */
    double crowd_second, crowd_fraction;
    bool accounting;
};

const char *axis_text(int code)
{
    static const char *const texts[] = {
        "done", "the table of events is full: read them and call again",
        "events follow each other and time does not go on: friction or inputs are too extreme for this axis",
        "the state leaves the range of numbers: a parameter or an input is too extreme for this axis",
        "the motion contradicts itself or its balance of energy: the engine is at fault, please report the scene",
        "the parameters are no axis: as many numbers as the header says, with a mass and segments, stiffness and damping not negative",
        "the inputs are none: finite numbers, pieces from 0 s on that rise, no more sinusoids than there is room for",
        "the time is none, or before the present one: whole seconds and a fraction from 0 to below 1",
        "the numbers are no state of this axis", "there is no memory for the axis"};
    return code >= 0 && code < (int)(sizeof texts / sizeof *texts) ? texts[code] : "there is no such code";
}

static bool axis_is_size(double number)
{
    return number >= 0.0 && number < INFINITY;
}

static bool axis_has_parameters(const double *numbers, size_t count, size_t most)
{
    if (count < AXIS_PARAMETERS || (count - AXIS_PARAMETERS) % AXIS_SEGMENT != 0) {
        return false;
    }
    size_t segments = (count - AXIS_PARAMETERS) / AXIS_SEGMENT;
    for (size_t i = 0; i < count; i++) {
        if (isnan(numbers[i])) {
            return false;
        }
    }
    double back = numbers[AXIS_BACKWARD_SEGMENT];
    return segments > 0 && segments <= most && numbers[AXIS_SEGMENT_COUNT] == (double)segments
        && numbers[AXIS_MASS] > 0.0 && numbers[AXIS_MASS] < INFINITY && axis_is_size(numbers[AXIS_STIFFNESS])
        && axis_is_size(numbers[AXIS_DAMPING]) && axis_is_size(numbers[AXIS_NORMAL_FORCE])
        && axis_is_size(numbers[AXIS_CONTACT_STIFFNESS]) && axis_is_size(numbers[AXIS_CONTACT_DAMPING])
        && (numbers[AXIS_COMPLIANT] == 0.0 || numbers[AXIS_CONTACT_STIFFNESS] > 0.0)
        && back >= 0.0 && back < (double)segments && back == floor(back);
}

void axis_scale_friction(double *parameters, size_t count, double factor)
{
    static const int scaled[] = {AXIS_STATIC_INITIAL, AXIS_STATIC_LIMIT, AXIS_BACKWARD_INITIAL, AXIS_BACKWARD_LIMIT,
                                 AXIS_END_SLOPE};
    for (size_t i = 0; i < sizeof scaled / sizeof *scaled; i++) {
        parameters[scaled[i]] *= factor;
    }
    for (size_t i = AXIS_PARAMETERS; i + AXIS_SEGMENT <= count; i += AXIS_SEGMENT) {
        Segment *segment = (Segment *)(parameters + i);
        segment->friction *= factor;
        segment->slope *= factor;
    }
}

static void axis_take_parameters(Parameters *p, const double *numbers, size_t count)
{
    Segment *segments = p->segments;
    memcpy(p, numbers, AXIS_PARAMETERS * sizeof(double));
    p->segments = segments;
    memcpy(segments, numbers + AXIS_PARAMETERS, (count - AXIS_PARAMETERS) * sizeof(double));
}

axis *axis_new(const double *parameters, size_t count, size_t sinusoids, size_t events, bool accounting, int *code)
{
    const size_t most = 1000000;
    *code = AXIS_BAD_PARAMETERS;
    if (parameters == NULL || events == 0 || events > most || sinusoids > most || count > most
        || !axis_has_parameters(parameters, count, most)) {
        return NULL;
    }
    size_t segments = (count - AXIS_PARAMETERS) / AXIS_SEGMENT;
    char *memory = calloc(1, sizeof(axis) + 2 * segments * sizeof(Segment) + events * sizeof(EventRow)
                          + sinusoids * (sizeof(SinusoidRecord) + sizeof(GivenSinusoid)));
    *code = memory == NULL ? AXIS_NO_MEMORY : AXIS_OK;
    if (memory == NULL) {
        return NULL;
    }
    axis *a = (axis *)memory;
    a->parameters.segments = (Segment *)(memory + sizeof(axis));
    a->next.segments = a->parameters.segments + segments;
    a->events.rows = (EventRow *)(a->next.segments + segments);
    a->state.sinusoids = (SinusoidRecord *)(a->events.rows + events);
    a->sinusoids.rows = (GivenSinusoid *)(a->state.sinusoids + sinusoids);
    a->state.scratch = a->scratch;
    a->events.count = (long)events;
    a->segments = segments;
    a->most = sinusoids;
    a->accounting = accounting;
    axis_take_parameters(&a->parameters, parameters, count);
    a->constant_normal_force = a->parameters.normal_force;
    return a;
}

void axis_free(axis *a)
{
    free(a);
}

static bool axis_is_profile(const axis_profile *of)
{
    if (of->count == 0) {
        return isfinite(of->value) && isfinite(of->rate);
    }
    for (size_t i = 0; i < of->count; i++) {
        double end = i + 1 < of->count ? of->starts[i + 1] : of->period;
        if (!(isfinite(of->starts[i]) && of->starts[i] < end && isfinite(of->values[i]) && isfinite(of->rates[i]))) {
            return false;
        }
    }
    return of->starts[0] == 0.0;
}

static const axis_profile *axis_profile_of(const axis_inputs *inputs, int i)
{
    return i == AXIS_DRIVE ? &inputs->drive : i == AXIS_FORCE ? &inputs->force : &inputs->normal;
}

static bool axis_are_inputs(const axis *a, const axis_inputs *inputs)
{
    bool are = inputs != NULL && inputs->sinusoid_count <= a->most;
    for (int i = 0; are && i < AXIS_INPUTS; i++) {
        are = (i == AXIS_NORMAL && !inputs->normal_varies) || axis_is_profile(axis_profile_of(inputs, i));
    }
    for (size_t i = 0; are && i < inputs->sinusoid_count; i++) {
        const axis_sinusoid *one = &inputs->sinusoids[i];
        are = isfinite(one->phase) && isfinite(one->v) && isfinite(one->f) && isfinite(one->n) && one->frequency >= 1e-9
            && one->frequency <= 1e6 && (inputs->normal_varies || one->n == 0.0);
    }
    return are;
}

/* Where the pieces at the present time end; what the inputs are there is `now`. */
static double axis_read_inputs(axis *a)
{
    double end = INFINITY;
    for (int i = 0; i < AXIS_INPUTS; i++) {
        a->now[i] = (Double3){a->constant_normal_force, 0.0, INFINITY};
        if (a->pieces[i].count > 0) {
            a->now[i] = pieces_piece_at(&a->pieces[i], a->second + a->fraction);
        }
        end = smaller(end, a->now[i].item2);
    }
    return end;
}

/* Let inputs be in force from the present time on. */
static void axis_take_inputs(axis *a, const axis_inputs *inputs)
{
    a->inputs = *inputs;
    for (int i = 0; i < AXIS_INPUTS; i++) {
        double *one = a->one_piece[i];
        axis_profile of = *axis_profile_of(inputs, i);
        one[0] = 0.0;
        one[1] = of.value + 0.0;
        one[2] = of.rate;
        if (of.count == 0) {
            of = (axis_profile){i < AXIS_NORMAL || inputs->normal_varies, one, one + 1, one + 2, INFINITY, 0.0, 0.0};
        }
        a->pieces[i] = (Pieces){.count = (long)of.count, .period = of.period, .starts = (double *)of.starts,
                                .values = (double *)of.values, .rates = (double *)of.rates};
    }
    a->sinusoids.count = (long)inputs->sinusoid_count;
    for (size_t i = 0; i < inputs->sinusoid_count; i++) {
        memcpy(&a->sinusoids.rows[i], &inputs->sinusoids[i], sizeof(GivenSinusoid));
    }
    a->until = axis_read_inputs(a);
}

/* Enter the pieces of the inputs up to a time. */
static long axis_enter(axis *a, double time)
{
    DoubleLong2 entered = pieces_enter_pieces(&a->parameters, &a->state, &a->pieces[AXIS_DRIVE], &a->pieces[AXIS_FORCE],
                                              &a->pieces[AXIS_NORMAL], a->until, time, &a->sinusoids, &a->events, 0);
    a->until = entered.item0;
    a->rows = entered.item1;
    return entered.item2;
}

int axis_start(axis *a, const axis_start_state *initial, const axis_inputs *inputs)
{
    a->rows = 0;
    if (!axis_are_inputs(a, inputs) || initial == NULL) {
        return AXIS_BAD_INPUTS;
    }
    if (!(isfinite(initial->position) && isfinite(initial->velocity) && isfinite(initial->stretch)
          && isfinite(initial->deflection) && initial->rest_time >= 0.0)) {
        return AXIS_BAD_STATE;
    }
    a->second = a->fraction = a->crowd_second = a->crowd_fraction = 0.0;
    a->crowd = 0;
    a->state.accounting = a->accounting ? 1.0 : 0.0;
    axis_take_inputs(a, inputs);
    const Double3 *v = &a->now[AXIS_DRIVE], *f = &a->now[AXIS_FORCE], *n = &a->now[AXIS_NORMAL];
    a->parameters.normal_force = n->item0;
    a->parameters.normal_rate = n->item1;
    a->rows = engine_start(&a->parameters, &a->state, initial->position, initial->velocity, initial->rest_time,
                           initial->stretch, initial->deflection, v->item0, v->item1, f->item0, f->item1, &a->sinusoids,
                           &a->events, 0);
    return AXIS_OK;
}

static bool axis_comes(const axis *a, double second, double fraction)
{
    return isfinite(second) && second == floor(second) && fraction >= 0.0 && fraction < 1.0
        && (second > a->second || (second == a->second && fraction >= a->fraction));
}

int axis_advance(axis *a, double second, double fraction)
{
    a->rows = 0;
    if (!axis_comes(a, second, fraction)) {
        return AXIS_BAD_TIME;
    }
    if (a->until <= second + fraction) {
        long code = axis_enter(a, second + fraction);
        if (code != AXIS_OK) {
            return (int)code;
        }
    }
    Long2 ended = engine_advance(&a->parameters, &a->state, second, fraction, &a->events, a->rows);
    a->rows = ended.item0;
    if (ended.item1 == AXIS_OK) {
        a->second = second;
        a->fraction = fraction;
    }
    return (int)ended.item1;
}

int axis_advance_to_event(axis *a, double second, double fraction)
{
    a->rows = 0;
    if (second + fraction == axis_time(a)) {    /* the same number: the present time may have more digits */
        second = a->second;
        fraction = a->fraction;
    }
    if (!axis_comes(a, second, fraction)) {
        return AXIS_BAD_TIME;
    }
    bool is_there = false;
    while (a->rows == 0 && !is_there) {
        is_there = a->until > second + fraction;
        double whole = is_there ? second : floor(a->until), rest = is_there ? fraction : a->until - whole;
        Events one = {.count = 1, .rows = a->events.rows};
        Long2 ended = engine_advance(&a->parameters, &a->state, whole, rest, &one, 0);
        a->rows = ended.item0;
        if (ended.item1 != AXIS_OK && ended.item1 != AXIS_FULL) {
            return (int)ended.item1;
        }
        a->second = a->rows > 0 ? a->events.rows->second : whole;
        a->fraction = a->rows > 0 ? a->events.rows->fraction : rest;
        if ((a->second - a->crowd_second) + (a->fraction - a->crowd_fraction) > AXIS_AT_ONCE) {
            a->crowd_second = a->second;
            a->crowd_fraction = a->fraction;
            a->crowd = 0;
        }
        a->crowd += a->rows;
        if (a->crowd > AXIS_MOST_AT_ONCE) {
            return AXIS_NO_PROGRESS;
        }
        if (a->rows == 0 && !is_there) {
            axis_enter(a, a->until);
        }
    }
    return AXIS_OK;
}

int axis_set_inputs(axis *a, const axis_inputs *inputs)
{
    a->rows = 0;
    if (!axis_are_inputs(a, inputs)) {
        return AXIS_BAD_INPUTS;
    }
    bool same_load = inputs->normal_varies == a->inputs.normal_varies
        && (!inputs->normal_varies || memcmp(&inputs->normal, &a->inputs.normal, sizeof inputs->normal) == 0);
    axis_take_inputs(a, inputs);
    const Double3 *v = &a->now[AXIS_DRIVE], *f = &a->now[AXIS_FORCE], *n = &a->now[AXIS_NORMAL];
    if (same_load) {
        a->rows = engine_set_inputs(&a->parameters, &a->state, a->second, a->fraction, v->item0, v->item1, f->item0,
                                    f->item1, &a->sinusoids, &a->events, 0);
    } else {
        a->rows = engine_set_load(&a->parameters, &a->state, a->second, a->fraction, n->item0, n->item1, v->item0,
                                  v->item1, f->item0, f->item1, &a->sinusoids, &a->events, 0);
    }
    return AXIS_OK;
}

int axis_set_parameters(axis *a, const double *parameters, size_t count)
{
    a->rows = 0;
    if (parameters == NULL || !axis_has_parameters(parameters, count, a->segments)) {
        return AXIS_BAD_PARAMETERS;
    }
    axis_take_parameters(&a->next, parameters, count);
    a->constant_normal_force = a->next.normal_force;
    axis_read_inputs(a);
    a->next.normal_force = a->now[AXIS_NORMAL].item0;
    a->next.normal_rate = a->now[AXIS_NORMAL].item1;
    a->rows = engine_set_parameters(&a->parameters, &a->next, &a->state, a->second, a->fraction, &a->events, 0);
    Parameters old = a->parameters;
    a->parameters = a->next;
    a->next = old;
    return AXIS_OK;
}

double axis_time(const axis *a)
{
    return a->second + a->fraction;
}

size_t axis_event_count(const axis *a)
{
    return (size_t)a->rows;
}

axis_event axis_event_at(const axis *a, size_t i)
{
    axis_event event = {0};
    if (i < (size_t)a->rows) {
        memcpy(&event, &a->events.rows[i], sizeof event);
    }
    return event;
}

int axis_sample(axis *a, axis_sample_row *out)
{
    SampleRow row;
    engine_sample(&a->parameters, &a->state, a->second, a->fraction, &row);
    memcpy(out, &row, sizeof row);
    double size = row.position + row.velocity + row.acceleration + row.drive + row.drive_force + row.friction;
    return isfinite(size) ? AXIS_OK : AXIS_OUT_OF_RANGE;
}

int axis_energy(axis *a, axis_energy_row *out)
{
    EnergyRow row = {0};
    if (a->accounting) {
        engine_energy(&a->parameters, &a->state, a->second, a->fraction, &row);
    }
    memcpy(out, &row, sizeof row);
    return !a->accounting || soundness_is_sound(&a->parameters, &a->state, a->second, a->fraction) ? AXIS_OK
        : AXIS_UNSOUND;
}

size_t axis_state_size(const axis *a)
{
    return AXIS_STATE + a->most * AXIS_SINUSOID + AXIS_OWN;
}

void axis_get_state(const axis *a, double *numbers)
{
    const double own[AXIS_OWN] = {a->second, a->fraction, a->until, a->parameters.normal_force, a->parameters.normal_rate};
    memcpy(numbers, &a->state, AXIS_STATE * sizeof(double));
    memcpy(numbers + AXIS_STATE, a->state.sinusoids, a->most * sizeof(SinusoidRecord));
    memcpy(numbers + AXIS_STATE + a->most * AXIS_SINUSOID, own, sizeof own);
}

static bool axis_is_index(double number, double end)
{
    return number >= 0.0 && number < end && number == floor(number);
}

int axis_set_state(axis *a, const double *numbers, size_t count)
{
    a->rows = 0;
    if (numbers == NULL || count != axis_state_size(a)) {
        return AXIS_BAD_STATE;
    }
    State state;
    memcpy(&state, numbers, AXIS_STATE * sizeof(double));
    const double *own = numbers + AXIS_STATE + a->most * AXIS_SINUSOID;
    if (!(axis_is_index(state.mode, 5.0) && axis_is_index(state.segment, (double)a->segments)
          && axis_is_index(state.direction + 1.0, 3.0) && axis_is_index(state.sinusoid_count, (double)a->most + 1.0)
          && axis_is_index(own[0], INFINITY) && own[1] >= 0.0 && own[1] < 1.0 && own[2] >= 0.0 && own[3] >= 0.0)) {
        return AXIS_BAD_STATE;
    }
    memcpy(&a->state, numbers, AXIS_STATE * sizeof(double));
    memcpy(a->state.sinusoids, numbers + AXIS_STATE, a->most * sizeof(SinusoidRecord));
    a->crowd_second = a->second = own[0];
    a->crowd_fraction = a->fraction = own[1];
    a->crowd = 0;
    a->until = own[2];
    a->parameters.normal_force = own[3];
    a->parameters.normal_rate = own[4];
    return AXIS_OK;
}
