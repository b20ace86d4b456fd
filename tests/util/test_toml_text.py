"""TOML that is written is what `tomllib` reads."""

from __future__ import annotations

import math
import string
import tomllib
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from dq_marine.util.toml_text import toml_text

scalars = st.one_of(
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    st.text(string.printable + "é\x7f\x00\u2028\U0001f6a2"),
)
keys = st.text(string.ascii_letters + "_-.é\"' ", min_size=1)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(keys, inner, max_size=3),
    max_leaves=8,
)


@given(st.dictionaries(keys, values, max_size=4))
def test_what_is_written_is_read_back(content: dict[str, Any]) -> None:
    assert tomllib.loads(toml_text(content)) == content


def test_tables_have_headings_and_none_is_left_out() -> None:
    content = {"a": 1, "b": {"x": 1e-05, "inner": {"y": [True, {"z": "q"}]}, "n": None}, "e": {}}
    text = toml_text(content)
    assert text == 'a = 1\n\n[b]\nx = 1e-05\n\n[b.inner]\ny = [true, { z = "q" }]\n\n[e]\n'
    assert math.isnan(tomllib.loads(toml_text({"a": math.nan}))["a"])
