"""Seabeds from files: the same depths from a NumPy file and a GeoTIFF, and what is wrong said by value and remedy."""

import copy
import json
import pickle

import numpy as np
import pytest
import tifffile

from dq_marine.charts import SeabedChart, seabed_chart
from dq_marine.charts.seabed_chart import MOST_SAMPLES
from dq_marine.errors import InvalidInputError, MissingDependencyError

DEPTHS = 40.0 + np.add.outer(np.sin(np.arange(6.0)), 0.5 * np.arange(5.0))
SCALE, TIEPOINT, TRANSFORMATION, KEYS, NODATA = 33550, 33922, 34264, 34735, 42113
METRES, DEGREES, FEET = (1, 9001), (2, 9001), (1, 9002)


def geotiff(path, depths, *, scale=(2.0, 2.0, 0.0), model=METRES, extra=(), **options):
    """Write depths row by row from the north, as GeoTIFFs have them."""
    keys = (1, 1, 0, 2, 1024, 0, 1, model[0], 3076, 0, 1, model[1])
    tags = [
        (TIEPOINT, "d", 6, (0.0, 0.0, 0.0, 5e5, 6e6, 0.0), True),
        (KEYS, "H", len(keys), keys, True),
        *extra,
    ]
    if scale is not None:
        tags.append((SCALE, "d", 3, scale, True))
    tifffile.imwrite(path, np.asarray(depths), extratags=tags, **options)
    return path


@pytest.mark.parametrize("compression", [None, "zlib"])
def test_a_numpy_file_and_a_geotiff_of_the_same_depths_are_the_same_seabed(tmp_path, compression):
    np.save(tmp_path / "bed.npy", DEPTHS)
    depths = seabed_chart({"file": str(tmp_path / "bed.npy"), "spacing": 2.0})
    same = seabed_chart(geotiff(tmp_path / "bed.tif", DEPTHS[::-1], compression=compression))
    heights = seabed_chart(str(geotiff(tmp_path / "heights.TIFF", -DEPTHS[::-1])))
    assert np.array_equal(depths.depths, DEPTHS)
    assert depths == same == heights
    assert depths.sides == (10.0, 8.0)
    assert depths.sheet.chart.depths[5:10] == tuple(DEPTHS[1])


def test_charts_travel_and_are_compared_by_what_they_say():
    chart = SeabedChart(DEPTHS, 2.0, "bed")
    for other in (pickle.loads(pickle.dumps(chart)), copy.deepcopy(chart)):
        assert other == chart
        assert hash(other) == hash(chart)
        assert other.sheet == chart.sheet
    assert chart != SeabedChart(DEPTHS, 2.5)
    assert chart != SeabedChart(DEPTHS + 1.0, 2.0)
    assert seabed_chart(chart) is chart
    assert "6 x 5 samples, 2 m apart" in repr(chart)


def test_what_a_file_says_of_a_seabed_goes_through_json(tmp_path):
    np.save(tmp_path / "bed.npy", DEPTHS)
    said = {"file": str(tmp_path / "bed.npy"), "spacing": 2}
    assert seabed_chart(json.loads(json.dumps(said))) == SeabedChart(DEPTHS, 2.0)


def changed(row, column, value):
    depths = DEPTHS.copy()
    depths[row, column] = value
    return depths


@pytest.mark.parametrize(
    ("depths", "spacing", "message"),
    [
        (changed(4, 1, np.nan), 2.0, r"not finite, the first in row 4 .* column 1.*fillnodata"),
        (changed(4, 1, np.inf), 2.0, "not finite"),
        (changed(4, 1, -3.0), 2.0, r"depths from -3 to .*cut off the land"),
        (1e3 * DEPTHS, 2.0, "at most 20000 m"),
        (DEPTHS[0], 2.0, r"shape \(5,\).*two or more"),
        (DEPTHS[:1], 2.0, r"shape \(1, 5\)"),
        (np.full((300, 300), 40.0), 2.0, r"300 x 300 = 90,000 samples; .*65,536.*\[::2, ::2\]"),
        (DEPTHS, 0.0, "spacing = 0"),
        (DEPTHS, "far", "spacing"),
        (DEPTHS, 0.1, r"no steeper than 2"),
        ([[1.0], [2.0, 3.0]], 2.0, "depths"),
        ("deep", 2.0, "depths"),
    ],
)
def test_wrong_depths_are_refused(depths, spacing, message):
    with pytest.raises(InvalidInputError, match=message):
        SeabedChart(depths, spacing)


def test_as_many_samples_as_told_are_taken():
    assert SeabedChart(np.full((2, MOST_SAMPLES // 2), 40.0), 1.0).depths.size == MOST_SAMPLES


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"scale": None}, "how large its pixels are"),
        ({"scale": (2.0, 3.0, 0.0)}, "2 x 3|3 x 2"),
        ({"scale": (np.nan, np.nan, 0.0)}, "nan"),
        ({"model": DEGREES}, r"not in metres \(GeoTIFF model 2.*gdalwarp"),
        ({"model": FEET}, "unit 9002"),
        ({"extra": [(TRANSFORMATION, "d", 16, tuple(np.eye(4).ravel()), True)]}, "turned against north"),
        ({"extra": [(NODATA, "s", 0, "41.0", True)], "depths": changed(5, 0, 41.0)}, "row 0 .* column 0"),
        ({"depths": np.zeros((3, 4, 2)), "planarconfig": "contig"}, r"shape \(3, 4, 2\).*one band"),
        ({"depths": np.zeros((400, 400))}, "160,000 samples"),
    ],
)
def test_wrong_geotiffs_are_refused(tmp_path, options, message):
    depths = options.pop("depths", DEPTHS)
    with pytest.raises(InvalidInputError, match=message):
        seabed_chart(geotiff(tmp_path / "bed.tif", depths, photometric="minisblack", **options))


def test_damaged_files_are_refused_whatever_is_cut_off(tmp_path):
    np.save(tmp_path / "bed.npy", DEPTHS)
    np.save(tmp_path / "objects.npy", np.array([{}], dtype=object))
    whole = geotiff(tmp_path / "bed.tif", DEPTHS, compression="zlib").read_bytes()
    for length in (0, 1, 5, 8, 40, len(whole) // 2):
        (tmp_path / "bed.tif").write_bytes(whole[:length])
        with pytest.raises(InvalidInputError, match=r"bed\.tif"):
            seabed_chart(tmp_path / "bed.tif")
    table = (tmp_path / "bed.npy").read_bytes()
    for length in (0, 3, 20, 100, len(table) - 1):
        (tmp_path / "bed.npy").write_bytes(table[:length])
        with pytest.raises(InvalidInputError, match=r"bed\.npy is no NumPy file"):
            seabed_chart({"file": tmp_path / "bed.npy", "spacing": 1.0})
    with pytest.raises(InvalidInputError, match=r"objects\.npy"):
        seabed_chart({"file": tmp_path / "objects.npy", "spacing": 1.0})


@pytest.mark.parametrize("name", ["bed.tif", "bed.npy"])
def test_of_files_with_wrong_bytes_nothing_else_comes_than_a_chart_or_a_refusal(tmp_path, name):
    path = tmp_path / name
    np.save(path, DEPTHS) if name.endswith("npy") else geotiff(path, DEPTHS, compression="zlib")
    given = {"file": path, "spacing": 1.0} if name.endswith("npy") else path
    whole, rng, refused = np.frombuffer(path.read_bytes(), np.uint8), np.random.default_rng(0), 0
    for _ in range(100):
        wrong = whole.copy()
        places = rng.integers(0, len(wrong), rng.integers(1, 4))
        wrong[places] = rng.integers(0, 256, len(places))
        path.write_bytes(wrong.tobytes())
        try:
            assert np.isfinite(seabed_chart(given).depths).all()
        except InvalidInputError:
            refused += 1
    assert 0 < refused < 100


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("nowhere.tif", "no such file"),
        ("bed.npy", "'spacing': metres"),
        ({"file": "bed.npy"}, "'spacing': metres"),
        ({"file": "bed.npy", "spacing": -1.0}, "spacing"),
        ({"file": "bed.npy", "spacing": 1.0, "unit": "m"}, "'unit'"),
        ({"spacing": 1.0}, "nothing called 'file'"),
        ({"file": "bed.tif", "spacing": 1.0}, "has its own; leave it out"),
        ("bed.csv", r"ending '\.csv'"),
        (7, "seabed = 7; give the path"),
        ("a\0b.tif", "no path"),
    ],
)
def test_other_wrong_words_are_refused(tmp_path, monkeypatch, given, message):
    monkeypatch.chdir(tmp_path)
    np.save("bed.npy", DEPTHS)
    geotiff("bed.tif", DEPTHS)
    (tmp_path / "bed.csv").write_text("40,41\n")
    with pytest.raises(InvalidInputError, match=message):
        seabed_chart(given)


def test_without_tifffile_the_message_says_what_to_install(tmp_path, monkeypatch):
    path = geotiff(tmp_path / "bed.tif", DEPTHS)
    monkeypatch.setitem(__import__("sys").modules, "tifffile", None)
    with pytest.raises(MissingDependencyError, match=r"dq-marine\[charts\]"):
        seabed_chart(path)
