"""`stickslip warm`: compile once, so that no other start has to."""

import click


@click.command(hidden=True)
def warm() -> None:
    """Compile the hot path into its cache, and see that it runs."""
    from ..offline import run_offline, warm_up
    from ..scene import load_scene

    for name in ('paper_fig7', 'paper_fig8', 'positioning'):
        scene = load_scene(name)
        warm_up(scene)
        run_offline(scene, 1.0, 0.01)
    warm_up(load_scene('paper_fig8', {'solver.name': 'fixed_step'}))
