"""The forces on a vehicle, one folder a phenomenon: formulas, tables of the vehicle file, and their builder."""
