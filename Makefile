# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0

# The two commands:  make run  (drive the axis and look at it),  make test
# `make help` lists the rest.  PYTHON=python3.12 sets up with another Python than python3.

DISTRO ?= jazzy
MINUTES ?= 10
PROCESSES ?= 4
export DISTRO
unexport PYTHONDONTWRITEBYTECODE  # pytest rewrites three hundred files, in each process: that is to be kept

SHELL := /bin/bash
HERE := ros2_ws/on_this_machine
TOOLS := ros2_ws/.venv/bin

.PHONY: help build run test check extremes bench identify hil soak cnc fuzz hostile goldens mutants timings pages docs clean

help:  ## list the targets
	@sed -nE 's/^([a-z]+):.*## (.*)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 14

build:  ## set up ros2_ws: ROS 2 from wheels, both packages with colcon
	@ros2_ws/bootstrap

run: build  ## run the node on the paper's scene, drive it, record it, show what happened
	@$(HERE) python3 -m stickslip_sim.ros.demo

test: tools  ## all tests, PROCESSES=4 at once, each in a ROS domain of its own
	@OPENBLAS_NUM_THREADS=1 $(HERE) python3 -m pytest tests --dist loadfile --no-loadscope-reorder --max-worker-restart 9 --tx '$(PROCESSES)*popen//python=$(HERE) --own-domain python3'

check: tools  ## style, types, architecture, dead code, spelling, words and links
	@$(TOOLS)/ruff check .
	@$(TOOLS)/mypy
	@PYTHONPATH=stickslip_sim $(TOOLS)/lint-imports
	@$(TOOLS)/vulture
	@$(TOOLS)/codespell
	@$(TOOLS)/python -m dev.links
	@$(TOOLS)/mkdocs build

extremes: tools  ## what breaks other simulators, measured beside its mark (minutes); fails when one is missed
	@$(HERE) python3 -m stickslip_sim extremes

bench: build  ## measure every solver beside its peers, and the loop of the node; writes docs/data/ (25 minutes)
	@ros2_ws/bootstrap --bench
	@$(HERE) python3 -m stickslip_sim bench --out runs/bench
	@$(HERE) --own-domain --shared-memory python3 benchmarks/tick.py --json runs/bench/bench.json
	@$(HERE) python3 -m benchmarks.accuracy runs/bench
	@$(HERE) --own-domain --shared-memory python3 -m benchmarks.loop
	@$(HERE) --own-domain --shared-memory python3 -m benchmarks.budget
	@$(HERE) python3 -m benchmarks.paper
	@$(HERE) python3 -m benchmarks.controllers

identify: build  ## what stickslip identify finds on 100 axes whose truth is known, beside others; writes docs/data/ (15 minutes)
	@OPENBLAS_NUM_THREADS=1 $(HERE) python3 -m benchmarks.identify

hil: build  ## the node with a controller beside it: against a bare rclpy node, and the highest rate; writes docs/data/
	@$(HERE) --own-domain --shared-memory python3 -m benchmarks.hil

soak: build  ## the node, recording, with a controller beside it for MINUTES=10; writes docs/data/, fails when a limit is missed
	@$(HERE) --own-domain --shared-memory python3 -m benchmarks.soak --minutes $(MINUTES)

cnc: tools  ## two axes under LinuxCNC's own motion and PID: a circle's figures; says so where LinuxCNC is not installed
	@$(HERE) python3 -m dev.cnc

fuzz: tools  ## made-up files and runs for MINUTES=10; fails when one is not read or refused in one line, or runs wrong
	@$(HERE) python3 -m tests.fuzz --minutes $(MINUTES)

hostile: tools  ## scenes near all that an event search may miss, for MINUTES=10, with SEED=; fails when one is found wrong
	@$(HERE) python3 -m tests.hostile --minutes $(MINUTES) $(if $(SEED),--seed $(SEED))

goldens: tools  ## what every verb writes for every scene, into runs/goldens/TO=now; compared with those of FROM=
	@$(HERE) python3 -m dev.goldens runs/goldens/$(or $(TO),now) $(if $(FROM),--against runs/goldens/$(FROM))

mutants: tools  ## small errors in a copy of the package, one by one: is each killed by the test that is named for it?
	@$(HERE) --own-domain python3 -m dev.mutants

timings: tools  ## start of tool and node, an hour offline: medians into runs/goldens/TO=now, beside those of FROM=
	@$(HERE) --own-domain --shared-memory python3 -m dev.timings runs/goldens/$(or $(TO),now) $(if $(FROM),--against runs/goldens/$(FROM))

pages: tools  ## docs/api.md, docs/scene.md and the packages' changelogs from the code, docs/measured.md from docs/data/
	@$(HERE) python3 -m dev.pages

docs: tools  ## the pages in docs/ as a site in runs/docs/
	@$(TOOLS)/mkdocs build && $(HERE) python3 -m stickslip_sim explore paper_fig8 --out runs/docs/explorer.html && echo runs/docs/index.html

clean:  ## remove everything that was set up, built or cached in this tree
	rm -rf ros2_ws/{.venv,build,install,log} runs .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
	rm -rf stickslip_sim/build stickslip_sim/stickslip_sim/_hot.* stickslip_sim/stickslip_sim/_{text,standstill,fmu}.*
	find . -name __pycache__ -prune -exec rm -rf {} +

.PHONY: tools
tools:
	@ros2_ws/bootstrap --tests
