# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements to a scene: friction curves and the laws that fit them; runs, and the parameters that make them.

What is in here, from the top floor down; each imports only from the floors below it:

    identify           the verb: from a run to what was found in it, with intervals, tests and slips
    run_friction       the friction curve out of a run
    break_away_scatter how break-aways scatter around the static law
    prediction         a scene along a run that it was not identified from
    other_laws         the run fitted with other laws, and the criterion that compares them
    report             what was found or predicted, as lines, page, values and a folder
    many_fits          fits from many starts, on several processes, and kept in a folder
    measured_friction  friction straight from a measurement, and where in its cycle a reading stands
    several_runs       several runs in one fit, and what they disagree about
    stages             from a start to the best fit of the whole run
    certainty          covariance, profiles, the noise of inputs, and tests that reject a model
    fit_problem        the residuals of slips, of stretches and of the whole run
    direct             numbers that readings say by themselves
    slip_features      figures of single slips
    axis_model         the axis with trial values
    run_start          the state in which a run begins
    force_noise        noise of a measured force: filters, and quiet rests
    least_squares      the least sum of squares within a region
    identified_scene   the scene that was found, as a file, and what is left open of it
    motions            slips and rests in what was measured
    free_parameters    what may change, and in which region
    readings           channels of a run, their sensors, and measured inputs
    identified         what an identification returns
    curve              a measured friction curve and its laws, without a run: the verb `friction`
"""
