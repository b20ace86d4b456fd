"""What `performance.py` measures, one section a file, and what they share: timing, record, page."""
