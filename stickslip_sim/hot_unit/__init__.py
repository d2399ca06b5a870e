# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the hot path, plain annotated Python, as one Cython unit, and builds it: `stickslip_sim._hot`.

| file             | what                                                                     |
|------------------|--------------------------------------------------------------------------|
| `sources.py`     | which files and functions belong to it, and the digest of the files      |
| `constants.py`   | numbers with a name, also those that another file or an enumeration has  |
| `c_types.py`     | what an annotation means in C                                            |
| `scope.py`       | what the names of a file mean in the unit                                |
| `local_types.py` | the types of the locals of a function                                    |
| `functions.py`   | a function as Cython takes it                                            |
| `records.py`, `records.pyx.in` | the records in C                           |
| `loops.pyx.in`   | what runs from axis to axis or piece to piece without Python, by hand    |
| `unit.py`        | all of it as one text                                                    |
| `build.py`       | the command of setuptools that compiles it                               |

Why one unit and why these flags: docs/solvers.md, "How the hot path is compiled".
"""
