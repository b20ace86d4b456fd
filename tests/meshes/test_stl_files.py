"""Reading STL files: both kinds give the same triangles, and what is no such file is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.solids import box, write_ascii_stl, write_stl

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.stl import read_stl


def test_both_kinds_give_the_triangles_that_were_written(tmp_path: Path) -> None:
    corners = box(2.0, 1.0, 0.5)
    np.testing.assert_array_equal(read_stl(write_stl(tmp_path / "b.stl", corners)), corners)
    np.testing.assert_array_equal(read_stl(write_ascii_stl(tmp_path / "a.stl", corners / 3.0)), corners / 3.0)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "neither a whole binary nor a whole ASCII"),
        (b"x" * 200, "neither a whole binary nor a whole ASCII"),
        (b"\0" * 84, "neither a whole binary nor a whole ASCII"),
        (b"solid x\nendsolid x\n", "0 facets with 0 vertices"),
        (
            b"solid x\nfacet normal 0 0 0\nvertex 0 0 0\nvertex 1 0 0\nendsolid x\n",
            "1 facets with 2 vertices",
        ),
        (b"solid x\nfacet\nvertex a b c\nvertex 1 0 0\nvertex 1 0 0\nendsolid\n", "could not convert"),
        (
            b"solid x\nfacet\nvertex nan 0 0\nvertex 1 0 0\nvertex 1 0 0\nendsolid\n",
            "triangle 1 of 1 has a coord",
        ),
    ],
)
def test_what_is_no_stl_file_is_refused(content: bytes, message: str, tmp_path: Path) -> None:
    (tmp_path / "hull.stl").write_bytes(content)
    with pytest.raises(InvalidInputError, match=message):
        read_stl(tmp_path / "hull.stl")


def test_a_file_cut_short_is_refused(tmp_path: Path) -> None:
    for write in (write_stl, write_ascii_stl):
        path = write(tmp_path / "hull.stl", box(2.0, 1.0, 0.5))
        path.write_bytes(path.read_bytes()[:-20])
        with pytest.raises(InvalidInputError, match="export the mesh as STL again"):
            read_stl(path)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="there is no mesh"):
        read_stl(tmp_path / "none.stl")
    with pytest.raises(InvalidInputError, match="there is no mesh"):
        read_stl(tmp_path)
