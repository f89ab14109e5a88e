"""The blocks of the book's page run as they stand, in one script, in their order."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "src" / "python.md"
# What the page takes for granted.
BEFORE = """
import matplotlib
matplotlib.use("Agg")
spec = {"preset": "fig-9", "axis": [{"key": "gap.amplitude", "values": [1e-3, 2e-3, 3e-3, 4e-3]}]}
"""
# A measured curve is what an experiment sees: the stable states alone.
FRAME = """
import pandas
smooth = {"gap.amplitude": 0.0, "basis.kind": "exact"}
exact = pulloff.Problem("fig-9", smooth).trace()
seen = exact.stable_displacement
frame = pandas.DataFrame({"approach": exact.approach[seen], "force": exact.force[seen]})
problem = pulloff.Problem("fig-9", {**smooth, "material.work_of_adhesion": 0.0041})
"""


def test_the_blocks_of_the_page_run(tmp_path):
    for needed in ("joblib", "distributed", "matplotlib", "pandas"):
        pytest.importorskip(needed, reason=f"LEFT OUT: {needed} is not installed, so the page of the book did not run")
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert len(blocks) > 6
    blocks = [FRAME + block if "frame" in block else block for block in blocks]
    # A worker imports the script: what is no function runs in the first process alone.
    guarded = "".join(
        block
        if "__main__" in block
        else 'if __name__ == "__main__":\n' + "".join(f"    {line}\n" for line in block.splitlines())
        for block in [blocks[0], *blocks[1:]]
    )
    script = tmp_path / "page.py"
    script.write_text(BEFORE + "import pulloff\n" + guarded)
    done = subprocess.run([sys.executable, script.name], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    numbers = [float(line) for line in done.stdout.split()]
    assert len(numbers) == 6 and all(force < 0.0 for force in numbers[:3]) and all(loss > 0.0 for loss in numbers[3:])
    assert (tmp_path / "rows.csv").read_text().count("\n") == 2
