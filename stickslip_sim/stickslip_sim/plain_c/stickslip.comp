// Copyright 2026 The stickslip authors
// SPDX-License-Identifier: Apache-2.0
component stickslip "a feed axis with stick-slip friction, exact: the scene $NAME of stickslip $VERSION";
description """
Velocity of the drive in, position of the slider out.  Each call takes the axis on by the nominal period of the thread.
It takes an input that is a number; with another one it goes on with the last number, \\fBfault\\fR is TRUE, and a
message says so once.  Where the engine stops, the pins stay as they are, and \\fBfault\\fR stays TRUE.
""";
pin in float velocity "velocity of the drive, machine units/s";
pin in float force "external force on the slider, N";
pin in float friction_scale = 1.0 "factor on all coefficients of friction, 0 to 100";
pin in bit enable = 1 "FALSE: its time stands still";
pin out float position_fb "position of the slider as the encoder counts it, machine units";
pin out float drive_fb "position of the drive, machine units";
pin out float drive_force "force of the drive on the slider, N";
pin out s32 mode "0 stick, 1 accelerating, 2 coasting, 3 decelerating, 4 yielding";
pin out u32 events "transitions since the start";
pin out bit fault "TRUE: an input or a parameter is out of range, or the engine has stopped";
param rw float resolution = $RESOLUTION "of the encoder, machine units; 0 does not round";
param rw float scale = 1000.0 "machine units per metre: 1000 in mm";
variable char label[48];
variable void *engine;
variable double *scaled;
variable double v;
variable double f;
variable double friction = 1.0;
variable double friction_in_force = 1.0;
variable rtapi_s64 nanoseconds;
variable unsigned count;
variable bool is_stopped;
option extra_setup;
option no_convenience_defines;
function _ fp "step by the period of the thread";
author "The stickslip authors";
license "Apache-2.0";
;;
#pragma GCC optimize ("O2", "fp-contract=off")   // FUNCTION: the same bits on every processor
#include <float.h>
#include "stickslip_axis.c"

#define SECOND 1000000000   // ns
static const double scene_parameters[] = {$PARAMETERS};
enum { COUNT = sizeof scene_parameters / sizeof *scene_parameters };
static const axis_start_state scene_start = {$INITIAL};

static int counted(struct __comp_state *one, int code)
{
    one->count += (unsigned)axis_event_count(one->engine);
    return code;
}

static int scale_friction(struct __comp_state *one)
{
    memcpy(one->scaled, scene_parameters, sizeof scene_parameters);   // it may be longer than the stack of a thread
    axis_scale_friction(one->scaled, COUNT, one->friction);
    one->friction_in_force = one->friction;
    return counted(one, axis_set_parameters(one->engine, one->scaled, COUNT));
}

static bool take(double *kept, double given, double least, double most)
{
    bool is_good = given >= least && given <= most;   // never of a NaN
    *kept = is_good ? given : *kept;
    return is_good;
}

static int step(struct __comp_state *one, double v, double f, long period)
{
    bool rises = one->friction > one->friction_in_force, falls = one->friction < one->friction_in_force;
    int code = rises ? scale_friction(one) : AXIS_OK;
    if (code == AXIS_OK && (one->v != v || one->f != f)) {
        const axis_inputs inputs = {.drive = {.value = one->v = v}, .force = {.value = one->f = f}};
        code = counted(one, axis_set_inputs(one->engine, &inputs));
    }
    if (code == AXIS_OK && falls) {   // last, as in Python: what holds before and afterwards must not break away
        code = scale_friction(one);
    }
    one->nanoseconds += period;
    double second = (double)(one->nanoseconds / SECOND), fraction = (double)(one->nanoseconds % SECOND) / SECOND;
    return code == AXIS_OK ? counted(one, axis_advance(one->engine, second, fraction)) : code;
}

static void _(struct __comp_state *one, long period)
{
    double v = one->v, f = one->f, scale = 1000.0, resolution = 0.0;
    bool was_fault = *one->fault, is_good = take(&scale, one->scale, DBL_MIN, DBL_MAX);
    is_good &= take(&resolution, one->resolution, 0.0, DBL_MAX);
    is_good &= take(&v, *one->velocity / scale, -DBL_MAX, DBL_MAX);
    is_good &= take(&f, *one->force, -DBL_MAX, DBL_MAX);
    is_good &= take(&one->friction, *one->friction_scale, 0.0, 100.0);
    axis_sample_row row;
    int code = one->is_stopped || !*one->enable ? AXIS_OK : step(one, v, f, period);
    if (code == AXIS_OK && !one->is_stopped) {
        code = axis_sample(one->engine, &row);
    }
    if (code != AXIS_OK) {
        one->is_stopped = true;
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: stopped at %.9g s: %s\n", one->label, axis_time(one->engine),
                        axis_text(code));
    }
    *one->fault = one->is_stopped || !is_good;
    if (!is_good && !was_fault) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: velocity and force have to be numbers, friction-scale 0 to 100, scale > 0,"
                        " resolution >= 0: going on with the last good ones\n", one->label);
    }
    if (one->is_stopped) {
        return;
    }
    double position = row.position * scale;
    *one->position_fb = resolution > 0.0 ? resolution * floor(position / resolution + 0.5) : position;
    *one->drive_fb = row.drive * scale;
    *one->drive_force = row.drive_force;
    *one->mode = (int)row.mode;
    *one->events = one->count;
}

static int extra_setup(struct __comp_state *one, char *prefix, long extra_arg)
{
    (void)extra_arg;
    const axis_inputs inputs = {0};
    int code;
    rtapi_snprintf(one->label, sizeof one->label, "%s", prefix);
    // never freed: a thread may step the axis until halcompile's own code has taken it out of HAL
    one->scaled = malloc(sizeof scene_parameters);
    one->engine = axis_new(scene_parameters, COUNT, 0, 1000, false, &code);
    if (one->engine != NULL) {
        code = one->scaled == NULL ? AXIS_NO_MEMORY : counted(one, axis_start(one->engine, &scene_start, &inputs));
    }
    if (code != AXIS_OK) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", prefix, axis_text(code));
    }
    return code == AXIS_OK ? 0 : -EINVAL;
}
