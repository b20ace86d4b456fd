"""Weather as dictionaries: wrong and missing names are said, with those that there are."""

import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.physics.weather import weather_of

REFUSED = [
    ({"kind": "sea"}, "a sea with the spectrum 'jonswap' lacks height, period; it takes components"),
    (
        {"kind": "sea", "significant_height": 1.0, "period": 6.0},
        "does not take 'significant_height' and lacks height; it takes",
    ),
    (
        {"kind": "sea", "spectrum": "pierson_moskowitz", "wind_speed": 9.0, "period": 6.0},
        "'pierson_moskowitz' does not take 'period'; it takes components, depth, direction, gravity, seed,",
    ),
    ({"kind": "sea", "height": 1.0, "period": 6.0, 2: 3}, "does not take 2; it takes"),
    ({"kind": "wind", "speed": 8.0}, "a wind lacks direction_from; it takes air_density"),
    (
        {"kind": "wind", "speed": 8.0, "direction_from": 3.0, "windage": {"area": 2.0}},
        "a windage does not take 'area' and lacks frontal_area, height, lateral_area, length",
    ),
]


@pytest.mark.parametrize(("given", "complaint"), REFUSED)
def test_names_are_checked(given, complaint):
    with pytest.raises(InvalidInputError) as refused:
        weather_of([given])
    assert complaint in str(refused.value)
