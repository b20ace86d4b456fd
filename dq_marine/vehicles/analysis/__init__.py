"""Numbers that follow from a vehicle: its sheet, and bodies with a closed form."""
