# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements to a scene: friction curves and the laws that fit them; runs, and the parameters that make them.

What is in here, from the top floor down; each imports only from the floors below it:

    identify    the verb: from a run to the scene that reproduces it
    report      what was found, for its reader: scene, what is left open of it, page, values
    findings    what the best fit amounts to
    search      from starts far off to the best fit; other laws
    certainty   covariance, profiles, tests of the residuals
    fit         the residuals, and their least squares within a region
    trial       the axis with trial values, and what its slips show
    given       the readings of a run, what is free, and checks of both
    identified  what an identification returns
    curve       a measured friction curve and its laws, without a run: the verb `friction`
"""
