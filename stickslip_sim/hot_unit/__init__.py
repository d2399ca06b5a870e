# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the hot path, plain annotated Python, as one file of C, and builds it for Python: `stickslip_sim._hot`.

| file             | what                                                                                     |
|------------------|------------------------------------------------------------------------------------------|
| `sources.py`     | which files and functions belong to it, their constants, and the digest of the files     |
| `kinds.py`       | what an annotation means in C; the records                                               |
| `scope.py`       | what the names of a file mean in the unit, and the types of a function's locals          |
| `printer.py`     | a function in C                                                                          |
| `javascript.py`  | the same functions in JavaScript                                                         |
| `unit.py`        | all of it as one text, and the words of the wrapper                                      |
| `wrapper.pyx.in` | the wrapper for Python: the records as classes, loops that run while other threads may   |
| `build.py`       | the command of setuptools that compiles it, and two helpers: of `cli`, of `ros`           |

Why one unit and why these flags: docs/solvers.md, "How the hot path is compiled".
"""
