/* Copyright 2026 The stickslip authors
   SPDX-License-Identifier: Apache-2.0

   One feed axis with friction: stick, slip and every event between them in closed form, as stickslip $VERSION has it.

   All units are SI: m, s, kg, N, J; angles in turns; times are whole seconds and a fraction of one, from 0 to below 1.
   No function but axis_new allocates, none has data of its own: any number of axes run side by side, each in one thread
   at a time.  Functions that return an int return an axis_code.  Compile with -ffp-contract=off and without fast math:
   the numbers are then those of the engine in Python to the last bit, where the C library is the same. */

#ifndef STICKSLIP_AXIS_H
#define STICKSLIP_AXIS_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    AXIS_OK,
    AXIS_FULL,            /* there was no room for an event: read those that there are, and call again */
    AXIS_NO_PROGRESS,     /* events without progress in time */
    AXIS_OUT_OF_RANGE,    /* the state leaves the range of numbers */
    AXIS_UNSOUND,         /* the motion contradicts itself or its balance of energy: report the scene */
    AXIS_BAD_PARAMETERS,
    AXIS_BAD_INPUTS,
    AXIS_BAD_TIME,
    AXIS_BAD_STATE,
    AXIS_NO_MEMORY
} axis_code;

/* Say in words what a code means, and what to do. */
const char *axis_text(int code);

/* Where the numbers of an axis stand in the row of its parameters; behind them follow $SEGMENT_SIZE for each segment:
   $SEGMENTS. */
enum {
$PARAMETERS
    AXIS_PARAMETERS
};

/* An input over simulation time: from starts[i] s on it is values[i] + rates[i] (t - starts[i]); starts[0] is 0.  With a
   finite period, s, the pieces begin anew every period; INFINITY: the last one holds.  Without pieces (count 0) it is
   value + rate t for ever: a constant or a ramp.  The arrays belong to the caller, and stay as long as they are in force. */
typedef struct {
    size_t count;
    const double *starts, *values, *rates;
    double period;
    double value, rate;
} axis_profile;

/* A sinusoid on top of the inputs: amplitude sin(2 pi (frequency t + phase)). */
typedef struct {
$GivenSinusoid
} axis_sinusoid;

typedef struct {
    axis_profile drive;     /* velocity of the drive, m/s */
    axis_profile force;     /* external force, N */
    bool normal_varies;     /* whether the next one is in force, or the constant one of the parameters */
    axis_profile normal;    /* normal force, N */
    size_t sinusoid_count;  /* copied: at most as many as axis_new made room for */
    const axis_sinusoid *sinusoids;
} axis_inputs;

/* How an axis begins.  A rest time of INFINITY: it has always stood. */
typedef struct {
    double position;     /* m */
    double velocity;     /* m/s */
    double rest_time;    /* s */
    double stretch;      /* m, drive position less position */
    double deflection;   /* m, of a compliant contact */
} axis_start_state;

enum { AXIS_STICK$MODES };
enum { AXIS_BREAKAWAY$KINDS };

typedef struct {
$EventRow
} axis_event;

typedef struct {
$SampleRow
} axis_sample_row;

typedef struct {
$EnergyRow
} axis_energy_row;

typedef struct axis axis;

/* Multiply all coefficients of friction in a row of parameters by a factor. */
void axis_scale_friction(double *parameters, size_t count, double factor);

/* Make an axis of `count` numbers as listed above, with room for so many sinusoids and for the events of one call, with
   an account of energy or without; NULL and a code where that is not possible. */
axis *axis_new(const double *parameters, size_t count, size_t sinusoids, size_t events, bool accounting, int *code);
void axis_free(axis *a);

/* Begin at time 0.  Each of the five functions below writes the events that it brings over those of the call before. */
int axis_start(axis *a, const axis_start_state *initial, const axis_inputs *inputs);

/* Go on to a time, which is not before the present one, through all pieces of the inputs. */
int axis_advance(axis *a, double second, double fraction);

/* Go on to the next event and stop there, or at a time if that is before. */
int axis_advance_to_event(axis *a, double second, double fraction);

/* Let other inputs be in force, or another axis of as many segments or fewer, from the present time on. */
int axis_set_inputs(axis *a, const axis_inputs *inputs);
int axis_set_parameters(axis *a, const double *parameters, size_t count);

/* The present time, s. */
double axis_time(const axis *a);

/* How many events the last call brought, and each of them. */
size_t axis_event_count(const axis *a);
axis_event axis_event_at(const axis *a, size_t i);

/* Read the state at the present time, and the energies since the start (0 without an account). */
int axis_sample(axis *a, axis_sample_row *out);
int axis_energy(axis *a, axis_energy_row *out);

/* All numbers of the state, from which axis_set_state goes on to the last bit, in any process: of an axis with the same
   parameters and the same room for sinusoids, that was started with the same inputs. */
size_t axis_state_size(const axis *a);
void axis_get_state(const axis *a, double *numbers);
int axis_set_state(axis *a, const double *numbers, size_t count);

#ifdef __cplusplus
}
#endif
#endif
