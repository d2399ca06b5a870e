/* The scene $NAME of stickslip $VERSION: prints its events and the state at the end.
   cc -std=c11 -O2 -ffp-contract=off -Wall -Wextra -Werror example.c stickslip_axis.c -lm */

#include <math.h>
#include <stdio.h>

#include "stickslip_axis.h"

static const double parameters[] = {
$PARAMETERS
};
$ARRAYS
static void print_events(const axis *a)
{
    for (size_t i = 0; i < axis_event_count(a); i++) {
        axis_event event = axis_event_at(a, i);
        printf("event %a %a %g %g %g %a %a\n", event.second, event.fraction, event.kind, event.mode, event.direction,
               event.position, event.velocity);
    }
}

int main(void)
{
    const double duration = $DURATION;
    const axis_inputs inputs = {
        .drive = $DRIVE,
        .force = $FORCE,
        .normal_varies = $VARIES,
        .normal = $NORMAL,
        .sinusoid_count = $COUNT,
        .sinusoids = $SINUSOIDS,
    };
    const axis_start_state initial = {$INITIAL};
    int code;
    axis *a = axis_new(parameters, sizeof parameters / sizeof *parameters, $COUNT, 64, true, &code);
    if (a == NULL) {
        fprintf(stderr, "error: %s\n", axis_text(code));
        return code;
    }
    code = axis_start(a, &initial, &inputs);
    while (code == AXIS_OK || code == AXIS_FULL) {
        print_events(a);
        if (code == AXIS_OK && axis_time(a) == duration) {
            break;
        }
        code = axis_advance(a, floor(duration), duration - floor(duration));
    }
    axis_sample_row row;
    axis_energy_row energies;
    if (code == AXIS_OK) {
        code = axis_sample(a, &row);
    }
    if (code == AXIS_OK) {
        code = axis_energy(a, &energies);
    }
    if (code != AXIS_OK) {
        fprintf(stderr, "error: %s\n", axis_text(code));
    } else {
        printf("end %a %a %a %a\n", row.position, row.velocity, row.drive_force, energies.stored);
    }
    axis_free(a);
    return code;
}
