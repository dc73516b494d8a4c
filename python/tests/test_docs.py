"""Every example in the documentation is executed, and every public name is documented."""

import doctest
import importlib
import inspect
import pkgutil
from pathlib import Path

import pytest

import galpix

MODULES = [module.name for module in pkgutil.iter_modules(galpix.__path__) if not module.name.startswith("_")]


@pytest.mark.parametrize("name", ["__init__", *MODULES])
def test_examples(name):
    module = galpix if name == "__init__" else importlib.import_module(f"galpix.{name}")
    assert doctest.testmod(module).failed == 0


def test_readme():
    result = doctest.testfile(str(Path(__file__).parents[1] / "README.md"), module_relative=False)
    assert result.failed == 0 and result.attempted > 5


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
