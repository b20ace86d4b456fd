"""What every environment of one vehicle shares."""
