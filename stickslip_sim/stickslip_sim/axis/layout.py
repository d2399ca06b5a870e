# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where each number stands in the flat arrays that the compiled code works on.

An axis is one array of parameters, followed by five numbers for each knot of the friction tables.  A state is one
array: the state of motion at an anchor (the last event or jump of an input), the inputs from there on, the closed form
of the motion since, and the next event.  Nothing in it changes until the next event, however time is split.
"""

# parameters of an axis
MASS, STIFFNESS, DAMPING, NORMAL = range(4)
COMPLIANT, CONTACT_STIFFNESS, CONTACT_DAMPING = range(4, 7)
STATIC_LAW, STATIC_INITIAL, STATIC_LIMIT, STATIC_TAU, STATIC_EXPONENT = range(7, 12)
BRANCHES, END_SLOPE, KNOTS = range(12, 15)
TABLE = 15                              # then (velocity, mu_k, psi, slopes of mu_k and psi above) for each knot
KNOT_SIZE = 5

# the anchor: time, mode, state of motion
SECOND, FRACTION = range(2)
MODE, DIRECTION, PIECE = range(2, 5)
POSITION, DRIVE, SPRING, VELOCITY, DEFLECTION, REST = range(5, 11)   # SPRING: drive position − position
ACCELERATION = 11                       # of a moving mode; its force residual over the mass
RESIDUAL = 12                           # N, coasting: drive force + external force − lower friction, along the slip
EXCESS = 13                             # E of this slip
# the inputs from the anchor on: v = V + V_RATE t, F_e = F + F_RATE t
V, V_RATE, F, F_RATE = range(14, 18)
# the closed form from the anchor on (along +x)
GAMMA, OMEGA2, NU, SLOW, FAST, JERK, SNAP = range(18, 25)
# the next event: time after the anchor, its kind, and up to when it was searched
NEXT, NEXT_KIND, SEARCHED = range(25, 28)
ITERATIONS = 28                         # of all searches for events so far
ORIGIN = 29                             # m, where the run began: POSITION and DRIVE count from there
# g, g′, G₁ and G₂ at AT after the anchor, near the next event or where the search ended; AT < 0: not there
AT, AT_G, AT_RATE, AT_FIRST, AT_SECOND = range(30, 35)
LAST = 35                               # how long each mode lasted last time: a first guess for the next time
# the same four at the instant NEAR after an anchor, for the oscillator with these two: what ticks of one length share
NEAR, NEAR_GAMMA, NEAR_OMEGA2, NEAR_G, NEAR_RATE, NEAR_FIRST, NEAR_SECOND = range(39, 46)
# waves: how many, the inputs at the anchor without them, and up to where a search for an event has come
WAVES, BASE_V, BASE_F, PROGRESS = range(46, 50)
# the account of energy, J, up to the anchor: whether it is kept (the rest is 0 without), what was stored at the start,
# then a sum for each of the works, the exchanges and the throughput of `energy.EnergyBalance`, and what rounding lost
ACCOUNTING, STORED_AT_START, SUMS = range(50, 53)
CONTACT_EXCHANGE, PARAMETER_EXCHANGE, THROUGHPUT = range(5, 8)   # behind the five works
SUM_COUNT = 8
# for solvers that step: the inputs as they were given, from a time on; V, F and their rates are then those at the state
INPUT_SECOND, INPUT_FRACTION, INPUT_V, INPUT_V_RATE, INPUT_F, INPUT_F_RATE, INPUT_WAVES = range(69, 76)
# and the grid of fixed steps: its last point, in ticks within its second; a step and a second in ticks; time beyond it
METHOD, GRID_SECOND, GRID_TICKS, STEP_TICKS, SECOND_TICKS, LEAD = range(76, 82)
# the oscillator that each mode had last
KEPT = 82
KEPT_SIZE = 5
STATE_SIZE = KEPT + 4 * KEPT_SIZE

# then a record for each wave, the first numbers as they are given: frequency Hz, phase turns, amplitudes m/s and N; at
# the anchor its phase in turns, sine and cosine of that, and its pull in N/s (see `waves`)
WAVE_FREQUENCY, WAVE_PHASE, WAVE_V, WAVE_F, WAVE_TURNS, WAVE_SINE, WAVE_COSINE, WAVE_PULL_RE, WAVE_PULL_IM = range(9)
WAVE_INPUTS = 4
WAVE_SIZE = 9

# a row of the event table; types.Event has the same order
(EVENT_SECOND, EVENT_FRACTION, EVENT_KIND, EVENT_MODE, EVENT_DIRECTION, EVENT_POSITION, EVENT_VELOCITY, EVENT_DRIVE,
 EVENT_DRIVE_FORCE, EVENT_FRICTION, EVENT_STATIC, EVENT_REST) = range(12)
EVENT_SIZE = 12

# a row of energies; energy.EnergyBalance has the same order
ENERGY_SIZE = 10

# a row of samples; types.Sample has the same order
SAMPLE_SIZE = 15
