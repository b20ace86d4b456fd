"""Sea and wind: what they are, and the forces they make.

    Scene("remus100", weather=(Sea(Jonswap(height=1.0, period=6.0), direction=0.5), Wind(8.0, direction_from=3.0)))

Angles are in radians from north towards east. Waves go to their `direction`; wind comes from its `direction_from`.
"""

from dq_marine.weather.choice import Weather, weather_of, weather_terms
from dq_marine.weather.drift import DriftCoefficients, SlowDrift
from dq_marine.weather.floating import Radiation
from dq_marine.weather.loads import WaveLoads
from dq_marine.weather.rao import ForceRAO
from dq_marine.weather.rao_files import read_force_rao
from dq_marine.weather.sea import Sea
from dq_marine.weather.spectra import Jonswap, ModifiedPiersonMoskowitz, PiersonMoskowitz, Spectrum
from dq_marine.weather.wind import Wind, Windage

__all__ = [
    "DriftCoefficients",
    "ForceRAO",
    "Jonswap",
    "ModifiedPiersonMoskowitz",
    "PiersonMoskowitz",
    "Radiation",
    "Sea",
    "SlowDrift",
    "Spectrum",
    "WaveLoads",
    "Weather",
    "Wind",
    "Windage",
    "read_force_rao",
    "weather_of",
    "weather_terms",
]
