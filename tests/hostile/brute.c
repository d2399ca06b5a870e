/* Copyright 2026 The stickslip authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * The model of docs/model.md by brute force, in long double: extrapolated midpoint steps of a twentieth of the fastest
 * rate, every guard looked at after each step, roots by secants within the step.  A guard that is zero as a mode begins is
 * decided by its first samples, which begin at 2^-24 of a step.  It knows neither the engine nor the reference.
 */
#include <math.h>

typedef long double R;

enum { STICK, ACCELERATING, COASTING, DECELERATING, YIELDING };                     /* modes */
enum { BREAKAWAY, COAST, ACCELERATE, DECELERATE, STOP, REVERSE, KNOT, YIELD };      /* events */
enum { CONSTANT, EXPONENTIAL, KATO, HYPERBOLIC, LOGARITHMIC };
enum { LEVELS = 5, SMALLEST = 24, SEARCHES = 120, AT_ONE_INSTANT = 40, MOST_STEPS = 300000 };

static const R PI = 3.14159265358979323846264338327950288L;
static const R NOTHING = 1e-15L;    /* of a scale: as good as zero */
static const R GRAZE = 1e-9L;       /* of a scale: too near to a graze to be sure */
static const R FADED = 1e-12L;      /* of a swing that nothing holds: soon it is said to have died out */

typedef struct {
    int pieces, sinusoids;
    const double *start, *value, *rate, *amplitude, *frequency, *phase;
} Profile;

typedef struct {
    int law, breakpoints, fractions;
    double initial, limit, time_constant, exponent, delay, end_slope;
    const double *speeds, *coefficients, *psi_speeds, *psi;
} Side;

typedef struct {
    double mass, stiffness, damping, feed_damping, contact_stiffness, contact_damping;
    int compliant, undeflected, by_drive;
    double velocity, rest_time, stretch, deflection, duration, steps;
    Side sides[2];               /* forwards, backwards */
    Profile drive, force, normal;
    int sticks;                  /* how many factors on mu_s there are, one for each stick; the last one stays */
    const double *factors;
} Problem;

typedef struct {
    double time, kind, mode, direction, velocity, doubtful;
} Row;

typedef struct { R w, u, d; } State;   /* stretch, velocity, deflection */

typedef struct {
    const Problem *p;
    R t, age, excess, low, high;       /* of the table's segment: low <= speed <= high, high < 0: no end */
    R mu, mu_slope, psi, psi_slope;    /* lines of the segment, at speed 0 */
    int mode, direction, piece[3];
    State y;
    R inverse;                         /* time in which something changes */
    int doubtful;
    Row *rows;
    int count, most;
    R swing;                           /* the largest force that turned the slider since something held it */
    int stick;                         /* the place of its factor */
} Axis;

static R input(const Profile *f, int piece, R t) {
    R sum = (R)f->value[piece] + (R)f->rate[piece] * (t - (R)f->start[piece]);
    for (int k = 0; k < f->sinusoids; k++)
        sum += (R)f->amplitude[k] * sinl(2 * PI * (R)f->frequency[k] * t + (R)f->phase[k]);
    return sum;
}

static R input_rate(const Profile *f, int piece, R t) {
    R sum = (R)f->rate[piece];
    for (int k = 0; k < f->sinusoids; k++) {
        R omega = 2 * PI * (R)f->frequency[k];
        sum += (R)f->amplitude[k] * omega * cosl(omega * t + (R)f->phase[k]);
    }
    return sum;
}

static R drive_at(const Axis *a, R t) { return input(&a->p->drive, a->piece[0], t); }
static R normal_at(const Axis *a, R t) { return input(&a->p->normal, a->piece[2], t); }
static const Side *side_of(const Axis *a, int direction) { return &a->p->sides[direction > 0 ? 0 : 1]; }

static R static_coefficient(const Axis *a, const Side *s, R age) {
    double factor = a->p->factors[a->stick], initial = fmax(factor * s->initial, s->coefficients[0]);
    double limit = fmax(factor * s->limit, initial);
    R rise = (R)limit - (R)initial, z;
    if (s->law == CONSTANT) return initial;
    if (isinf((double)age)) return limit;
    z = (age > (R)s->delay ? age - (R)s->delay : 0) / (R)s->time_constant;
    if (s->law == EXPONENTIAL) return (R)initial - rise * expm1l(-z);
    if (s->law == KATO) return (R)initial - rise * expm1l(-powl(z, (R)s->exponent));
    if (s->law == HYPERBOLIC) return (R)initial + rise * z / (1 + z);
    return (R)initial + rise * log1pl(z);
}

/* the line of a table on the segment that begins at or below a speed (strictly below it, where the speed falls) */
static void line(const double *x, const double *y, int n, R end, R at, int below, R *value, R *slope) {
    int k = 0;
    while (k + 1 < n && (below ? (R)x[k + 1] < at : (R)x[k + 1] <= at)) k++;
    *slope = k + 1 < n ? ((R)y[k + 1] - (R)y[k]) / ((R)x[k + 1] - (R)x[k]) : end;
    *value = (R)y[k] - *slope * (R)x[k];
}

static void find_segment(Axis *a, R speed, int falling) {
    const Side *s = side_of(a, a->direction);
    a->low = 0, a->high = -1;
    for (int pass = 0; pass < 2; pass++) {
        const double *x = pass ? s->psi_speeds : s->speeds;
        for (int k = 0; k < (pass ? s->fractions : s->breakpoints); k++) {
            R breakpoint = x[k];
            int is_below = falling ? breakpoint < speed : breakpoint <= speed;
            if (is_below && breakpoint > a->low) a->low = breakpoint;
            if (!is_below && (a->high < 0 || breakpoint < a->high)) a->high = breakpoint;
        }
    }
    line(s->speeds, s->coefficients, s->breakpoints, s->end_slope, speed, falling, &a->mu, &a->mu_slope);
    a->psi = a->psi_slope = 0;
    if (s->fractions) line(s->psi_speeds, s->psi, s->fractions, 0, speed, falling, &a->psi, &a->psi_slope);
}

static R net_force(const Axis *a, R t, const State *y) {
    const Problem *p = a->p;
    return (R)p->stiffness * y->w + (R)p->feed_damping * drive_at(a, t) - (R)p->damping * y->u
        + input(&p->force, a->piece[1], t);
}

static R contact_force(const Axis *a, const State *y) {
    return (R)a->p->contact_stiffness * y->d + (R)a->p->contact_damping * y->u;
}

static R kinetic(const Axis *a, R u) { return a->mu + a->mu_slope * a->direction * u; }
static R raised(const Axis *a, R u) { return a->excess * (a->psi + a->psi_slope * a->direction * u); }
static R at_rest(const Axis *a, int direction) { return side_of(a, direction)->coefficients[0]; }

static State rates(const Axis *a, R t, const State *y) {
    const Problem *p = a->p;
    State f = { drive_at(a, t) - y->u, 0, 0 };
    R friction;
    if (a->mode == COASTING || (a->mode == STICK && !p->compliant)) return f;
    if (a->mode == STICK) {
        friction = contact_force(a, y);
        f.d = y->u;
    } else if (a->mode == YIELDING) {
        friction = a->direction * normal_at(a, t) * at_rest(a, a->direction);
        f.d = p->contact_damping > 0 ? (friction - (R)p->contact_stiffness * y->d) / (R)p->contact_damping : 0;
    } else {
        R mu = kinetic(a, y->u) + (a->mode == ACCELERATING ? raised(a, y->u) : 0);
        friction = a->direction * normal_at(a, t) * mu;
    }
    f.u = (net_force(a, t, y) - friction) / (R)p->mass;
    return f;
}

static State moved(const State *y, R h, const State *f) {
    State z = { y->w + h * f->w, y->u + h * f->u, y->d + h * f->d };
    return z;
}

/* Midpoint rules of 2, 4, 6 ... steps, extrapolated to no step size */
static State step(const Axis *a, R t, State y, R length) {
    R table[LEVELS][3];
    if (length <= 0) return y;
    for (int level = 0; level < LEVELS; level++) {
        int n = 2 * (level + 1);
        R h = length / n;
        State f = rates(a, t, &y), before = y, now = moved(&y, h, &f);
        for (int k = 1; k < n; k++) {
            State next;
            f = rates(a, t + k * h, &now);
            next = moved(&before, 2 * h, &f);
            before = now, now = next;
        }
        f = rates(a, t + length, &now);
        now = moved(&now, h, &f);
        table[level][0] = (before.w + now.w) / 2;
        table[level][1] = (before.u + now.u) / 2;
        table[level][2] = (before.d + now.d) / 2;
        for (int k = level - 1; k >= 0; k--) {
            R ratio = (R)n / (2 * (k + 1));
            for (int i = 0; i < 3; i++)
                table[k][i] = table[k + 1][i] + (table[k + 1][i] - table[k][i]) / (ratio * ratio - 1);
        }
    }
    return (State){ table[0][0], table[0][1], table[0][2] };
}

static R force_scale(const Axis *a, R t, const State *y) {
    R mu = 0;
    for (int k = 0; k < 2; k++) {
        R most = fmaxl(a->p->sides[k].limit, fmaxl(a->p->sides[k].initial, a->p->sides[k].coefficients[0]));
        mu = fmaxl(mu, most);
    }
    return fabsl(normal_at(a, t)) * mu + fabsl((R)a->p->stiffness * y->w) + (R)a->p->damping * fabsl(y->u)
        + (R)a->p->feed_damping * fabsl(drive_at(a, t)) + fabsl(input(&a->p->force, a->piece[1], t)) + 1e-300L;
}

/* both guards, each 0 or more while the mode lasts, and the scales on which they are nothing */
static void guards(const Axis *a, R t, const State *y, R g[2], R scale[2]) {
    R s = force_scale(a, t, y), speed = s * a->inverse / (R)a->p->mass;
    R normal = normal_at(a, t);
    scale[0] = scale[1] = s;
    if (a->mode == STICK) {
        R force = a->p->compliant && !a->p->by_drive ? contact_force(a, y) : net_force(a, t, y);
        R age = a->age + t;
        for (int k = 0; k < 2; k++) g[k] = normal * static_coefficient(a, &a->p->sides[k], age) - (k ? -force : force);
    } else if (a->mode == COASTING) {
        g[0] = a->direction * net_force(a, t, y) - normal * kinetic(a, y->u);
        g[1] = normal * raised(a, y->u) - g[0];
    } else if (a->mode == YIELDING) {
        if (a->p->contact_damping > 0)
            g[0] = a->direction * contact_force(a, y) - normal * at_rest(a, a->direction);
        else {
            R rate = input_rate(&a->p->normal, a->piece[2], t);
            g[0] = a->direction * y->u - at_rest(a, a->direction) * rate / (R)a->p->contact_stiffness;
            scale[0] = speed;
        }
        g[1] = -a->direction * y->u;
        scale[1] = speed;
    } else {
        int way = a->mode == ACCELERATING ? 1 : -1;
        g[0] = way * a->direction * rates(a, t, y).u;
        scale[0] = s / (R)a->p->mass;
        g[1] = way > 0 ? (a->high < 0 ? INFINITY : a->high - a->direction * y->u) : a->direction * y->u - a->low;
        scale[1] = speed;
    }
}

static void list(Axis *a, int kind, int direction) {
    if (a->count < a->most) {
        Row row = { (double)a->t, kind, a->mode, direction, (double)a->y.u, a->doubtful };
        a->rows[a->count] = row;
    }
    a->count++;
}

/* the sub-mode of a slip; on a border between two, what the border does at a constant speed */
static int sub_mode(Axis *a) {
    R eps = 1e-6L * a->inverse, s = force_scale(a, a->t, &a->y), r[2], band[2];
    State later = { a->y.w + eps * (drive_at(a, a->t) - a->y.u), a->y.u, a->y.d };
    find_segment(a, fabsl(a->y.u), 0);
    for (int k = 0; k < 2; k++) {
        R t = k ? a->t + eps : a->t;
        r[k] = a->direction * net_force(a, t, k ? &later : &a->y) - normal_at(a, t) * kinetic(a, a->y.u);
        band[k] = normal_at(a, t) * raised(a, a->y.u);
    }
    if (r[0] > band[0] + NOTHING * s) return ACCELERATING;
    if (r[0] < -NOTHING * s) return DECELERATING;
    if (r[0] >= band[0] - NOTHING * s && r[1] > band[1] + NOTHING * s) return ACCELERATING;
    if (r[0] <= NOTHING * s && r[1] < -NOTHING * s) return DECELERATING;
    return COASTING;
}

static void begin_branch(Axis *a, int mode) {
    a->mode = mode;
    find_segment(a, fabsl(a->y.u), mode == DECELERATING);
}

static void begin_slip(Axis *a, int direction, R coefficient) {
    const Side *s = side_of(a, direction);
    a->direction = direction;
    find_segment(a, fabsl(a->y.u), 0);
    R psi = a->psi + a->psi_slope * fabsl(a->y.u), left = coefficient - kinetic(a, a->y.u);
    a->excess = s->fractions && psi > 0 && left > 0 ? left / psi : 0;
    a->y.d = 0;
    R gap = direction * net_force(a, a->t, &a->y) - normal_at(a, a->t) * (kinetic(a, a->y.u) + raised(a, a->y.u));
    int mode = sub_mode(a);
    if (mode == COASTING && !a->p->by_drive && fabsl(gap) < NOTHING * normal_at(a, a->t) * coefficient)
        mode = ACCELERATING;   /* no coast to speak of */
    begin_branch(a, mode);
}

static void next_stick(Axis *a) { if (a->stick + 1 < a->p->sticks) a->stick++; }

static void arrest(Axis *a) {
    int back = -a->direction;
    next_stick(a);
    R normal = normal_at(a, a->t), holds = normal * static_coefficient(a, side_of(a, back), 0);
    a->y.u = 0;
    if (normal == 0) {
        R force = fabsl(net_force(a, a->t, &a->y));
        if (force < FADED * a->swing) a->doubtful = 1;
        a->swing = fmaxl(a->swing, force);
    } else {
        a->swing = 0;
    }
    if (a->p->by_drive) {
        R beyond = back * net_force(a, a->t, &a->y) - holds;
        if (fabsl(beyond) < GRAZE * force_scale(a, a->t, &a->y)) a->doubtful = 1;
        if (beyond > NOTHING * force_scale(a, a->t, &a->y)) {
            begin_slip(a, back, static_coefficient(a, side_of(a, back), 0));
            list(a, REVERSE, back);
            return;
        }
    }
    if (a->p->compliant)
        a->y.d = a->p->undeflected ? 0 : a->direction * normal * at_rest(a, a->direction) / (R)a->p->contact_stiffness;
    a->mode = STICK;
    a->age = -a->t;
    list(a, STOP, a->direction);
}

/* a contact that yields without a damper is deflected as far as its force says */
static void follow_limit(Axis *a) {
    if (!(a->p->contact_damping > 0))
        a->y.d = a->direction * normal_at(a, a->t) * at_rest(a, a->direction) / (R)a->p->contact_stiffness;
}

static void leave_stick(Axis *a, int sign) {
    R coefficient = static_coefficient(a, side_of(a, sign), a->age + a->t);
    R speed = force_scale(a, a->t, &a->y) * a->inverse / (R)a->p->mass;
    int moves = fabsl(a->y.u) > NOTHING * speed ? (a->y.u > 0 ? 1 : -1) : 0, direction = sign;
    if (a->p->compliant && a->p->by_drive) {
        direction = moves ? moves : sign;
    } else if (a->p->compliant) {
        R yielding = normal_at(a, a->t) * at_rest(a, sign);
        if (moves ? moves != sign : sign * net_force(a, a->t, &a->y) < yielding) {
            a->mode = YIELDING;
            a->direction = sign;
            follow_limit(a);
            list(a, YIELD, sign);
            return;
        }
    }
    begin_slip(a, direction, coefficient);
    list(a, BREAKAWAY, direction);
}

/* what follows where guard `which` of the mode has come to zero */
static void follow(Axis *a, int which) {
    int old = a->mode;
    if (old == STICK) {
        leave_stick(a, which ? -1 : 1);
    } else if (old == YIELDING && which == 0) {
        a->mode = STICK;
        next_stick(a);
        a->age = -a->t;
        list(a, STOP, a->direction);
    } else if (old == YIELDING) {
        a->y.u = 0;
        begin_slip(a, a->direction, 0);
        list(a, BREAKAWAY, a->direction);
    } else if (old == COASTING) {
        begin_branch(a, which ? ACCELERATING : DECELERATING);
        list(a, which ? ACCELERATE : DECELERATE, a->direction);
    } else if (which == 1 && old == DECELERATING && a->low == 0) {
        arrest(a);
    } else if (which == 1) {
        a->y.u = a->direction * (old == ACCELERATING ? a->high : a->low);
        begin_branch(a, old);
        list(a, KNOT, a->direction);
    } else {
        R band = normal_at(a, a->t) * raised(a, a->y.u);
        int wide = band > NOTHING * force_scale(a, a->t, &a->y);
        if (wide) find_segment(a, fabsl(a->y.u), 0);
        if (wide) a->mode = COASTING;
        else begin_branch(a, old == ACCELERATING ? DECELERATING : ACCELERATING);
        list(a, wide ? COAST : old == ACCELERATING ? DECELERATE : ACCELERATE, a->direction);
    }
}

static R guard_after(const Axis *a, R length, int which) {
    State y = step(a, a->t, a->y, length);
    R g[2], scale[2];
    guards(a, a->t + length, &y, g, scale);
    return g[which];
}

/* where a guard that is g0 now, and negative at `high`, falls below 0: by secants that are halved on a side that stays */
static R root_before(const Axis *a, R high, int which, R g0, R g1) {
    R low = 0, closest = high * 1e-18L;
    int kept = 0;
    for (int k = 0; k < SEARCHES && high - low > closest; k++) {
        R share = g0 > 0 && g1 < 0 ? g0 / (g0 - g1) : 0.5L;
        R middle = low + (high - low) * (k % 8 == 7 ? 0.5L : share), g;
        if (middle <= low || middle >= high) middle = low + (high - low) / 2;
        g = guard_after(a, middle, which);
        if (g < 0) {
            high = middle, g1 = g;
            if (kept < 0) g0 /= 2;
            kept = -1;
        } else {
            low = middle, g0 = g;
            if (kept > 0) g1 /= 2;
            kept = 1;
        }
    }
    return high;
}

/* how fast the guard changes, from a tiny way along the motion */
static R guard_rate(const Axis *a, R t, const State *y, int which, R eps) {
    R g[2], later[2], scale[2];
    State f = rates(a, t, y), next = moved(y, eps, &f);
    guards(a, t, y, g, scale);
    guards(a, t + eps, &next, later, scale);
    return (later[which] - g[which]) / eps;
}

/* where a guard that falls and rises again within a step is least */
static R least(const Axis *a, R h, int which) {
    R low = 0, high = h;
    for (int k = 0; k < SEARCHES; k++) {
        R left = low + (high - low) / 3, right = high - (high - low) / 3;
        if (guard_after(a, left, which) < guard_after(a, right, which)) high = right; else low = left;
    }
    return low + (high - low) / 2;
}

static R when_below(Axis *a, R h, int which, R g0, R g1, R scale, const State *end) {
    R eps = 1e-7L * h, rate0, rate1, share, place, value;
    if (g1 < 0) return root_before(a, h, which, g0, g1);
    if (!isfinite((double)g1)) return -1;
    rate0 = guard_rate(a, a->t, &a->y, which, eps), rate1 = guard_rate(a, a->t + h, end, which, eps);
    if (rate0 >= 0 || rate1 <= 0) return -1;
    share = (g1 - g0 - rate1 * h) / ((rate0 - rate1) * h);   /* where the tangents meet */
    if (g0 + rate0 * h * fmaxl(0, fminl(1, share)) > GRAZE * scale) return -1;
    place = least(a, h, which);
    value = guard_after(a, place, which);
    if (fabsl(value) < GRAZE * scale) a->doubtful = 1;
    return value < 0 ? root_before(a, place, which, g0, value) : -1;
}

/* the fastest rate of the mode and its inputs, 1/s */
static R fastest(const Axis *a) {
    const Problem *p = a->p;
    const Profile *inputs[3] = { &p->drive, &p->force, &p->normal };
    int gives = a->mode == STICK && p->compliant, slips = a->mode == ACCELERATING || a->mode == DECELERATING;
    R damping = (R)p->damping + (gives ? (R)p->contact_damping : 0), top;
    if (slips) damping += normal_at(a, a->t) * fabsl(a->mu_slope + (a->mode == ACCELERATING) * a->excess * a->psi_slope);
    top = fmaxl(damping / (R)p->mass, sqrtl(((R)p->stiffness + (gives ? (R)p->contact_stiffness : 0)) / (R)p->mass));
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < inputs[i]->sinusoids; k++) top = fmaxl(top, 2 * PI * (R)inputs[i]->frequency[k]);
    if (a->mode == YIELDING && p->contact_damping > 0) top = fmaxl(top, (R)p->contact_stiffness / (R)p->contact_damping);
    return fmaxl(top, 1 / (R)p->duration);
}

static R next_border(const Axis *a) {
    const Profile *inputs[3] = { &a->p->drive, &a->p->force, &a->p->normal };
    R stop = INFINITY;
    for (int i = 0; i < 3; i++)
        if (a->piece[i] + 1 < inputs[i]->pieces) stop = fminl(stop, inputs[i]->start[a->piece[i] + 1]);
    return stop;
}

static void change_inputs(Axis *a) {
    const Profile *inputs[3] = { &a->p->drive, &a->p->force, &a->p->normal };
    if (a->mode == YIELDING) follow_limit(a);
    for (int i = 0; i < 3; i++)
        while (a->piece[i] + 1 < inputs[i]->pieces && inputs[i]->start[a->piece[i] + 1] <= a->t) a->piece[i]++;
    if (a->mode == YIELDING && !(a->p->contact_damping > 0)) {
        R force = normal_at(a, a->t) * at_rest(a, a->direction), kept = a->direction * (R)a->p->contact_stiffness * a->y.d;
        if (kept < force - NOTHING * force_scale(a, a->t, &a->y)) follow(a, 0);
    }
    if (a->mode == ACCELERATING || a->mode == COASTING || a->mode == DECELERATING) {
        int old = a->mode, mode = sub_mode(a);
        begin_branch(a, mode);
        if (mode != old)
            list(a, mode == COASTING ? COAST : mode == ACCELERATING ? ACCELERATE : DECELERATE, a->direction);
    }
}

/* Return the number of events, or −1 where they, or the steps, do not end. */
int brute_force(const Problem *p, Row *rows, int most) {
    Axis a = { p, 0, p->rest_time, 0, 0, -1, 0, 0, 0, 0, STICK, 1, {0, 0, 0},
               { p->stretch, p->velocity, p->deflection }, 0, 0, rows, 0, most, 0, 0 };
    R longest = 0, border, h = 0, g0[2], scale[2], entered = -1;
    State entry = a.y;
    int armed[2], sinks[2] = { 1, 1 }, fresh = 1, here = 0, steps = 0;
    a.inverse = 1 / fastest(&a);
    if (p->velocity != 0 && p->deflection == 0) {
        a.direction = p->velocity > 0 ? 1 : -1;
        begin_slip(&a, a.direction, 0);
    }
    border = next_border(&a);
    while (a.t < (R)p->duration && a.count < a.most) {
        R stop = fminl(border, (R)p->duration), g1[2], end_scale[2], root = -1;
        int which = -1, last;
        if (++steps > MOST_STEPS) return -1;
        if (fresh) {
            if (a.mode == YIELDING) follow_limit(&a);
            a.inverse = 1 / fastest(&a);
            longest = a.inverse / (R)p->steps;
            guards(&a, a.t, &a.y, g0, scale);
            for (int k = 0; k < 2; k++) armed[k] = g0[k] > NOTHING * scale[k], sinks[k] = 1;
            entry = a.y;
            here = a.t == entered ? here + 1 : 0;
            if (here > AT_ONE_INSTANT) return -1;
            entered = a.t, fresh = 0;
            h = ldexpl(longest, -SMALLEST);
            for (int k = 0; k < 2; k++)
                if (which < 0 && g0[k] < -NOTHING * scale[k]) which = k, root = 0;
        }
        last = a.t + h >= stop;
        if (last) h = stop - a.t;
        State end = step(&a, a.t, a.y, h);
        if (which < 0) {
            guards(&a, a.t + h, &end, g1, end_scale);
            for (int k = 0; k < 2; k++) {
                R found = -1;
                if (armed[k]) found = when_below(&a, h, k, g0[k], g1[k], end_scale[k], &end);
                else if (g1[k] >= 0) sinks[k] = 0;
                else if (g1[k] < -NOTHING * end_scale[k]) found = 0;
                if (found >= 0 && (which < 0 || found < root)) which = k, root = found;
            }
        }
        if (which >= 0) {
            R rate;
            if (!armed[which] && sinks[which]) a.y = entry, a.t = entered;   /* below 0 ever since */
            a.y = step(&a, a.t, a.y, root);
            a.t += root;
            if (a.mode == YIELDING) follow_limit(&a);
            rate = guard_rate(&a, a.t, &a.y, which, 1e-6L * a.inverse);
            if (root > 0 && fabsl(rate) * a.inverse < 1e-7L * scale[which]) a.doubtful = 1;
            follow(&a, which);
            fresh = 1;
            continue;
        }
        a.y = end;
        a.t = last ? stop : a.t + h;
        for (int k = 0; k < 2; k++) {
            g0[k] = g1[k], scale[k] = end_scale[k];
            if (g0[k] > NOTHING * scale[k]) armed[k] = 1;
        }
        h = fminl(2 * h, longest);
        if (last && stop == border) {
            change_inputs(&a);
            border = next_border(&a);
            fresh = 1;
        }
    }
    return a.count;
}

/* ---- a segment between two events, as a solver has it -------------------------------------------------------------- */

typedef struct {
    int mode, direction, stick;
    double second, fraction, length, stretch, velocity, deflection, excess, rest_time;
    double noise[4];             /* of stretch, velocity, deflection, excess */
    double rounding, margin;     /* of a force, of all forces; so much more is a find */
} Segment;

typedef struct {
    double below[2], time[2], bound[2];    /* how far a guard is passed most beyond its bound, when, and that bound */
    double last[2], last_bound[2];
    double stretch, velocity, stretch_bound, velocity_bound;
} Verdict;

enum { IMAGES = 5 };   /* the motion, and those with one number of its start moved by its noise */

static void look(const Axis a[IMAGES], R begin, const Segment *s, Verdict *v) {
    R g[2], scale[2], moved[2] = { 0, 0 }, now = a->t - begin;
    guards(a, a->t, &a->y, g, scale);
    for (int i = 1; i < IMAGES; i++) {
        R other[2], unused[2];
        guards(&a[i], a->t, &a[i].y, other, unused);
        for (int k = 0; k < 2; k++) if (isfinite((double)g[k])) moved[k] += fabsl(other[k] - g[k]);
    }
    for (int k = 0; k < 2; k++) {
        R late, bound;
        if (!isfinite((double)g[k])) continue;
        late = fabsl(guard_rate(a, a->t, &a->y, k, 1e-6L * a->inverse)) * (5e-16L + 2e-15L * now);
        bound = (R)s->margin * (moved[k] + late + (R)s->rounding * scale[k]);
        if (-g[k] - bound > (R)v->below[k] - (R)v->bound[k])
            v->below[k] = (double)-g[k], v->time[k] = (double)now, v->bound[k] = (double)bound;
        v->last[k] = (double)g[k], v->last_bound[k] = (double)bound;
    }
}

/* where a guard that falls and rises within a step of the motion is least, it is looked at, too */
static void look_between(const Axis a[IMAGES], R h, R begin, const Segment *s, Verdict *v) {
    R g0[2], g1[2], scale[2];
    State end = step(a, a->t, a->y, h);
    guards(a, a->t, &a->y, g0, scale);
    guards(a, a->t + h, &end, g1, scale);
    for (int k = 0; k < 2; k++) {
        R rate0, rate1, place;
        Axis there[IMAGES];
        if (!isfinite((double)g0[k])) continue;
        rate0 = guard_rate(a, a->t, &a->y, k, 1e-7L * h), rate1 = guard_rate(a, a->t + h, &end, k, 1e-7L * h);
        if (rate0 >= 0 || rate1 <= 0) continue;
        if (g0[k] + rate0 * fmaxl(0, fminl(h, (g1[k] - g0[k] - rate1 * h) / (rate0 - rate1))) > 0) continue;
        place = least(a, h, k);
        for (int i = 0; i < IMAGES; i++) {
            there[i] = a[i];
            there[i].y = step(&a[i], a[i].t, a[i].y, place);
            there[i].t += place;
        }
        Verdict kept = *v;
        look(there, begin, s, v);
        for (int j = 0; j < 2; j++) v->last[j] = kept.last[j], v->last_bound[j] = kept.last_bound[j];
    }
}

/* Follow a segment to its end and look at both guards all along; return 0, or −1 where that takes too many steps. */
int follow_segment(const Problem *p, const Segment *s, Verdict *v) {
    const Profile *inputs[3] = { &p->drive, &p->force, &p->normal };
    R begin = (R)s->second + (R)s->fraction, end = begin + (R)s->length, longest, h;
    Axis a[IMAGES];
    for (int i = 0; i < IMAGES; i++) {
        State y = { (R)s->stretch + (i == 1) * (R)s->noise[0], (R)s->velocity + (i == 2) * (R)s->noise[1],
                    (R)s->deflection + (i == 3) * (R)s->noise[2] };
        Axis one = { p, begin, (R)s->rest_time - begin, (R)s->excess + (i == 4) * (R)s->noise[3], 0, -1, 0, 0, 0, 0,
                     s->mode, s->direction, {0, 0, 0}, y, 0, 0, 0, 0, 0, 0, s->stick };
        for (int k = 0; k < 3; k++)
            while (one.piece[k] + 1 < inputs[k]->pieces && inputs[k]->start[one.piece[k] + 1] <= begin) one.piece[k]++;
        find_segment(&one, fabsl((R)s->velocity), s->mode == DECELERATING);
        one.inverse = 1 / fastest(&one);
        a[i] = one;
    }
    for (int k = 0; k < 2; k++) v->below[k] = -INFINITY, v->bound[k] = v->time[k] = v->last[k] = v->last_bound[k] = 0;
    longest = a->inverse / (R)p->steps;
    h = ldexpl(fminl(longest, (R)s->length), -SMALLEST);
    look(a, begin, s, v);
    for (int steps = 0; a->t < end; steps++) {
        int last = a->t + h >= end;
        if (steps > MOST_STEPS) return -1;
        if (last) h = end - a->t;
        look_between(a, h, begin, s, v);
        for (int i = 0; i < IMAGES; i++) {
            a[i].y = step(&a[i], a[i].t, a[i].y, h);
            a[i].t = last ? end : a[i].t + h;
        }
        look(a, begin, s, v);
        h = fminl(2 * h, longest);
    }
    v->stretch = (double)(a->y.w - (R)s->stretch), v->velocity = (double)a->y.u;
    v->stretch_bound = v->velocity_bound = 0;
    for (int i = 1; i < IMAGES; i++) {
        v->stretch_bound += (double)fabsl(a[i].y.w - a->y.w);
        v->velocity_bound += (double)fabsl(a[i].y.u - a->y.u);
    }
    State f = rates(a, a->t, &a->y);
    v->stretch_bound += (double)(fabsl(f.w) * (5e-16L + 2e-15L * (R)s->length));
    v->velocity_bound += (double)(fabsl(f.u) * (5e-16L + 2e-15L * (R)s->length));
    return 0;
}
