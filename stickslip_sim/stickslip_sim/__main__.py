# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`python3 -m stickslip_sim` is the tool `stickslip`."""

from .cli import main

if __name__ == '__main__':
    main()
