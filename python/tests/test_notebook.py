"""The notebook runs, and makes the plot of the README."""

import os
import re

import pytest

from conftest import PROJECT

nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed: the notebook is not run")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel", reason="ipykernel is not installed: the notebook is not run")
pytest.importorskip("matplotlib", reason="matplotlib is not installed: the notebook is not run")


def test_the_notebook_makes_the_plot(tmp_path, monkeypatch):
    monkeypatch.setitem(os.environ, "GALPIX_FIGURES", str(tmp_path))
    notebook = nbformat.read(PROJECT / "python/examples/frames_ahead.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    made = (tmp_path / "frames-ahead.svg").read_text()
    kept = (PROJECT / "docs/plots/frames-ahead.svg").read_text()
    assert len(lines(kept)) == 6 and lines(made).keys() == lines(kept).keys()
    for name, points in lines(kept).items():
        assert len(points) == 12 and lines(made)[name] == pytest.approx(points, abs=0.5), name


def lines(svg):
    """The points of each line by its name, in the units of the picture."""
    groups = re.findall(r'<g id="([^"]+)">\s*<path d="([^"]+)"', svg)
    names = {"galpix, second layer", "galpix", "integer splat", "float bilinear", "float nearest", "hold"}
    return {
        name: [float(number) for number in re.findall(r"[-.0-9]+", path)] for name, path in groups if name in names
    }
