"""Sea and wind, and the forces that they make on a vehicle.

    Scene("remus100", weather=(Sea(Jonswap(height=1.0, period=6.0), direction=0.5), Wind(8.0, direction_from=3.0)))

Angles are in radians from north towards east. Waves travel in their `direction`; wind comes from its `direction_from`.
"""

from dq_marine.physics.waves.floating import Radiation
from dq_marine.physics.waves.loads import WaveLoads
from dq_marine.physics.waves.rao import ForceRAO
from dq_marine.physics.waves.rao_files import read_force_rao
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.slow_drift import DriftCoefficients, SlowDrift
from dq_marine.physics.waves.spectra import Jonswap, ModifiedPiersonMoskowitz, PiersonMoskowitz, Spectrum
from dq_marine.physics.weather.choice import Weather, weather_of, weather_terms
from dq_marine.physics.wind.build import Wind, Windage

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
