"""Every parameter of a scene: the one list behind the check of files, the declaration in ROS, and the reference.

Defaults are for what is left out.  The axis is the paper's; whatever else is left out is not modelled: no friction, a
rigid contact, a drive that stands still, no force.  (A node without any file runs the scene `paper_fig8`, not this.)
"""

import math

from .parameter import Parameter, When

_SOLVERS = ('exact', 'fixed_step', 'adaptive')
_METHODS = ('euler', 'rk4', 'RK45', 'DOP853', 'Radau', 'BDF', 'LSODA')
_MODES = ('realtime',)
_LAWS = ('constant', 'exponential', 'kato', 'hyperbolic', 'logarithmic')
_COURSES = ('constant', 'ramp', 'steps', 'table')

_GROWS = When('friction.static.law', _LAWS[1:])
_COMPLIANT = When('contact.model', ('compliant',))
_FIXED_STEP = When('solver.name', ('fixed_step',))
_ADAPTIVE = When('solver.name', ('adaptive',))
_BRANCHES = When('friction.acceleration_dependence', (True,))


def _number(name: str, default: float | None, unit: str, description: str, *, low: float = -math.inf,
            high: float = math.inf, above: bool = False, infinite: bool = False, live: bool = False,
            when: When | None = None) -> Parameter:
    """Return a double from `low` (excluded with `above`) to `high`; required when it has no default."""
    return Parameter(name, 'double', default, unit, description, low, high, above or low == -math.inf,
                     high == math.inf and not infinite, (), live, when, default is None)


def _numbers(name: str, default: tuple[float, ...] | None, unit: str, description: str, *, low: float = -math.inf,
             live: bool = False, when: When | None = None, required: bool = True) -> Parameter:
    """Return a list of finite doubles."""
    return Parameter(name, 'double_array', default, unit, description, low, math.inf, low == -math.inf, True,
                     (), live, when, required and default is None)


def _choice(name: str, default: str, description: str, choices: tuple[str, ...]) -> Parameter:
    return Parameter(name, 'string', default, '', description, choices=choices)


def _course(section: str, value: str, rate: str, values: str, unit: str, what: str) -> tuple[Parameter, ...]:
    """Return the parameters of an input course of `what`, which is a `unit`."""
    ramp = When(f'{section}.course', ('ramp',))
    knots = When(f'{section}.course', ('steps', 'table'))
    return (
        _choice(f'{section}.course', 'constant',
                f'how the {what} goes on offline, and in the node until a command arrives: constant; ramp (to a'
                ' constant); steps (jumps); table (linear between knots)', _COURSES),
        _number(f'{section}.{value}', 0.0, unit, f'{what}; of a ramp the one at its start',
                when=When(f'{section}.course', ('constant', 'ramp'))),
        _number(f'{section}.{rate}', None, f'{unit}/s' if unit == 'N' else 'm/s²', f'change of the {what}, of a ramp',
                when=ramp),
        _number(f'{section}.duration', math.inf, 's', 'of a ramp; then its last value holds', low=0.0, above=True,
                infinite=True, when=ramp),
        _numbers(f'{section}.times', None, 's', 'when the values of steps or a table begin: 0, then each later',
                 low=0.0, when=knots),
        _numbers(f'{section}.{values}', None, unit, f'{what} at these times; the last one holds', when=knots),
        _number(f'{section}.period', math.inf, 's', 'after which steps or a table begin again (.inf: never); a table is'
                ' linear from its last knot back to the first', low=1e-6, infinite=True, when=knots),
    )


PARAMETERS: tuple[Parameter, ...] = (
    Parameter('scene', 'string', 'unnamed', '', 'name of the scene, for people'),

    _number('axis.mass', 350.0, 'kg', "slider m; default: the paper's", low=0.0, above=True, live=True),
    _number('axis.drive_stiffness', 6.0e5, 'N/m', "drive spring c; default: the paper's", low=0.0, live=True),
    _number('axis.drive_damping', 4000.0, 'N s/m', "drive damper h; default: the paper's", low=0.0, live=True),
    _number('axis.normal_force', 3432.3275, 'N', 'normal force N, friction = coefficient times N; not in the paper,'
            ' default: the weight of its 350 kg (it does not follow axis.mass)', low=0.0, live=True),

    _choice('contact.model', 'rigid', 'contact in stick: rigid (the slider stands still) or compliant (a spring and a'
            ' damper)', ('rigid', 'compliant')),
    _number('contact.stiffness', None, 'N/m', 'tangential contact spring c_c, in stick only', low=0.0, above=True,
            live=True, when=_COMPLIANT),
    _number('contact.damping', 0.0, 'N s/m', 'tangential contact damper h_c, in stick only', low=0.0, live=True,
            when=_COMPLIANT),

    _choice('friction.static.law', 'constant', 'growth of the static coefficient mu_s with the rest time', _LAWS),
    _number('friction.static.initial', 0.0, '', 'mu_s at zero rest time', low=0.0, live=True),
    _number('friction.static.limit', None, '', 'mu_s upon infinite rest (logarithmic: initial + one unit of growth)',
            low=0.0, live=True, when=_GROWS),
    _number('friction.static.time_constant', None, 's', 'tau of the growth of mu_s', low=0.0, above=True, live=True,
            when=_GROWS),
    _number('friction.static.exponent', None, '', "n of Kato's law exp(-(t/tau)^n)", low=0.0, above=True, live=True,
            when=When('friction.static.law', ('kato',))),
    _numbers('friction.kinetic.velocities', (0.0,), 'm/s', 'knots of the kinetic coefficient; the first is 0, each is'
             ' higher, the last is v_gr', low=0.0, live=True),
    _numbers('friction.kinetic.coefficients', (0.0,), '', 'mu_k at these speeds', low=0.0, live=True),
    _number('friction.kinetic.end_slope', 0.0, 's/m', 'slope of mu_k beyond the last knot', low=0.0, live=True),
    Parameter('friction.acceleration_dependence', 'bool', False, '', 'whether the accelerating branch of mu_k lies'
              ' above the decelerating one (Fig. 6) instead of one curve for both (Fig. 3)'),
    _numbers('friction.excess.velocities', None, 'm/s', 'knots of psi, the shape of the excess of the accelerating'
             ' branch; left out: linear to 0 at the last knot of mu_k', low=0.0, live=True, when=_BRANCHES,
             required=False),
    _numbers('friction.excess.fractions', None, '', 'psi at these speeds: 1 at the first, 0 at the last', low=0.0,
             live=True, when=_BRANCHES, required=False),

    *_course('drive', 'velocity', 'acceleration', 'velocities', 'm/s', 'velocity of the drive end of the spring'),
    *_course('force', 'constant', 'rate', 'forces', 'N', 'external force on the slider, along +x'),

    _number('initial.position', 0.0, 'm', 'slider and drive at the start; the spring is unstretched'),
    _number('initial.velocity', 0.0, 'm/s', 'slider at the start'),
    _number('initial.rest_time', math.inf, 's', 'rest before the start (.inf: prolonged rest)', low=0.0, infinite=True),

    _choice('solver.name', 'exact', 'exact: closed form, from event to event; fixed_step: the usual loop, to compare'
            ' with; adaptive: steps of a stated tolerance, offline only (docs/solvers.md)', _SOLVERS),
    Parameter('solver.method', 'string', None, '', 'with fixed_step euler or rk4, left out: euler; with adaptive one of'
              ' the others, left out: DOP853', choices=_METHODS, when=When('solver.name', _SOLVERS[1:])),
    _number('solver.step', 1e-3, 's', 'length of a step', low=1e-9, high=1.0, when=_FIXED_STEP),
    _number('solver.rtol', 1e-8, '', 'error of a step relative to travel and velocity', low=2.3e-14, high=1e-2,
            when=_ADAPTIVE),
    _number('solver.atol', 1e-10, 'm, m/s', 'error of a step in travel and velocity', low=1e-300, high=1.0,
            when=_ADAPTIVE),

    _choice('time.mode', 'realtime', 'realtime: simulation time follows the clock of the machine', _MODES),
    _number('time.rate', 1000.0, 'Hz', 'steps per second of simulation time', low=1.0, high=20_000.0),
    _number('time.factor', 1.0, '', 'simulation time per real time', low=1e-3, high=1e3),

    _number('command.max_velocity', 1.0, 'm/s', 'a drive_velocity beyond it, either way, is refused', low=0.0,
            above=True, live=True),
    _number('command.max_force', 1.0e5, 'N', 'an external_force beyond it, either way, is refused', low=0.0, above=True,
            live=True),

    _number('command.timeout', 0.0, 's', 'silence after which a command is stale; 0: off, and nothing else yet',
            low=0.0, high=0.0),
    _choice('command.on_timeout', 'hold', 'what follows a stale command: hold, and nothing else yet', ('hold',)),

    _number('encoder.resolution', 0.0, 'm', 'of the measured position; 0: exact, and nothing else yet', low=0.0,
            high=0.0),

    Parameter('record.enabled', 'bool', False, '', 'whether the node records a bag from the start'),
    Parameter('record.folder', 'string', '', '', 'folder of the bag, which must not exist; empty: the node chooses',
              live=True),

    Parameter('seed', 'integer', 0, '', 'of everything random in the run', 0, 2**63 - 1),
)

BY_NAME: dict[str, Parameter] = {entry.name: entry for entry in PARAMETERS}
