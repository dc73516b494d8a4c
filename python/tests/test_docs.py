"""Every example in the documentation is executed, and every public name is documented."""

import doctest
import importlib
import inspect
import pkgutil
from pathlib import Path

import pytest

import galpix
from conftest import PROJECT

MODULES = [
    module.name
    for module in pkgutil.walk_packages(galpix.__path__, "galpix.")
    if not module.name.rsplit(".")[-1].startswith("_")
]


@pytest.mark.parametrize("name", ["galpix", *MODULES])
def test_examples(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0


def test_all_modules_are_looked_at():
    assert {"galpix.budget", "galpix.map", "galpix.bench.suite", "galpix.speed"} <= set(MODULES)


@pytest.mark.parametrize("path", ["python/README.md", "docs/sweeps.md", "docs/benchmark.md"])
def test_texts(path):
    if "sweeps" in path:
        pytest.importorskip("pyarrow", reason="pyarrow is not installed: the examples of docs/sweeps.md are not run")
    result = doctest.testfile(str(PROJECT / path), module_relative=False)
    assert result.failed == 0 and result.attempted > 3


def test_every_public_name_is_documented():
    for name in galpix.__all__:
        value = getattr(galpix, name)
        if callable(value):
            assert inspect.getdoc(value), name
            assert name in ("Component",) or inspect.signature(value), name


def test_the_stubs_name_what_the_extension_module_has():
    stubs = (Path(galpix.__file__).parent / "_galpix.pyi").read_text()
    missing = [
        name
        for name in dir(galpix._galpix)
        if not name.startswith("_") and f" {name}(" not in stubs and f"class {name}:" not in stubs
    ]
    assert not missing
    assert (Path(galpix.__file__).parent / "py.typed").exists()
