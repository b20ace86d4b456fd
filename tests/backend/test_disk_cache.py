"""Compiled code on disk: it is loaded by the next one, and whatever goes wrong with it, functions compile and run."""

import os
import subprocess
import sys

import pytest
from support.child_compilation import HERE

from dq_marine.backend import disk_cache
from dq_marine.backend.compilation import compile_function


def square(x):
    return x * x


def double(x):
    return 2.0 * square(x)


@pytest.fixture(autouse=True, scope="module")
def parts_known(tmp_path_factory):
    """The first compilation in a process keeps parts, too; the tests here look at the files of the function alone."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(disk_cache.CACHE_DIRECTORY_VARIABLE, str(tmp_path_factory.mktemp("parts")))
        patch.setenv(HERE, "1")
        run()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where compiled code is kept in this test, in which nothing has been said yet."""
    monkeypatch.setenv(disk_cache.CACHE_DIRECTORY_VARIABLE, str(tmp_path))
    monkeypatch.setenv(HERE, "1")
    disk_cache._announce_failure.cache_clear()
    disk_cache.announce_compilation()
    return tmp_path


def run():
    """Return whether the function was loaded; it must be right in any case."""
    compiled = compile_function(double, "a test")
    assert compiled(3.0) == 18.0
    return sum(compiled.stats.cache_hits.values()) > 0


def said(capsys):
    return capsys.readouterr().err.splitlines()


def test_the_next_one_loads_what_the_first_kept(folder, capsys):
    assert not run()
    assert run()
    assert said(capsys) == []
    assert {path.suffix for path in folder.rglob("*.nb?")} == {".nbi", ".nbc"}


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize(
    "damage", [lambda data: data[: len(data) // 2], lambda data: b"", lambda data: b"x" * 999]
)
def test_a_file_that_cannot_be_read_is_said_and_written_anew(suffix, damage, folder, capsys):
    run()
    (path,) = folder.rglob(f"*{suffix}")
    path.write_bytes(damage(path.read_bytes()))
    said(capsys)
    assert not run()
    (line,) = said(capsys)
    assert "cannot be loaded" in line
    assert str(folder) in line
    assert run()
    assert said(capsys) == []


def test_a_full_disk_is_said_once(folder, capsys, monkeypatch):
    def full(self, key, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("numba.core.caching.IndexDataCacheFile.save", full)
    assert not run()
    assert not run()
    (line,) = said(capsys)
    assert "cannot be kept" in line
    assert "No space left" in line


def test_a_cache_that_numba_makes_otherwise_is_done_without(folder, capsys, monkeypatch):
    def otherwise(self, py_func):
        raise AttributeError("'_Locator' object has no attribute '_py_file'")

    monkeypatch.setattr("numba.core.caching.Cache.__init__", otherwise)
    assert not run()
    (line,) = said(capsys)
    assert "_py_file" in line


PROGRAM = """
from dq_marine.backend.compilation import compile_function

def rare(x): return x - 1.0
def inner(x): return x * x
def plain(x): return 2.0 * inner(x)
def user(x): return rare(x) + inner(x)

for function, apart in ((plain, ()), (user, (rare,))):
    compiled = compile_function(function, "test", apart)
    print(compiled(4.0), sum(compiled.stats.cache_hits.values()))
"""


def test_without_optimisation_functions_run_and_are_loaded_where_they_can_be(tmp_path):
    """Numba then leaves addresses of this process in code that calls a function compiled apart: not to be kept."""
    script = tmp_path / "script.py"
    script.write_text(PROGRAM)
    variables = os.environ | {
        "NUMBA_OPT": "0",
        disk_cache.CACHE_DIRECTORY_VARIABLE: str(tmp_path / "cache"),
        "PYTHONWARNINGS": "error",
    }
    for loaded in (0, 1):
        done = subprocess.run(
            [sys.executable, script], env=variables, capture_output=True, text=True, check=True
        )
        assert done.stdout.splitlines() == [f"32.0 {loaded}", "19.0 0"]
        assert done.stderr.count("cannot be kept") == 1
