"""Charts from files: seabeds from tables of depths and GeoTIFFs, and distances to a solid from its mesh."""

from dq_marine.charts.choice import seabed_chart
from dq_marine.charts.seabed_chart import SeabedChart

__all__ = ["SeabedChart", "seabed_chart"]
