"""Put what `stickslip bench` wrote, and tick.py added to it, into docs/accuracy.md, between its markers.

    python3 benchmarks/accuracy.py runs/bench
"""

import json
import pathlib
import shutil
import sys

from stickslip_sim.bench.report import markdown

PAGE = pathlib.Path('docs/accuracy.md')
IMAGES = pathlib.Path('docs/images')
BEGIN, END = '<!-- generated: begin -->', '<!-- generated: end -->'


def main() -> None:
    """Replace the generated part and the pictures."""
    folder = pathlib.Path(sys.argv[1])
    before, begin, rest = PAGE.read_text(encoding='utf-8').partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise SystemExit(f'{PAGE} lacks {BEGIN} or {END}')
    table = markdown(json.loads((folder / 'bench.json').read_text(encoding='utf-8')))
    PAGE.write_text(f'{before}{BEGIN}\n\n{table}\n{END}{after}', encoding='utf-8')
    for name in ('trade', 'trade_scenes'):
        if (folder / f'{name}.png').is_file():
            shutil.copy(folder / f'{name}.png', IMAGES / f'{name}.png')


if __name__ == '__main__':
    main()
