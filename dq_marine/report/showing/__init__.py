"""What was measured, shown: figures, tables, findings and the page. Nothing here decides what is measured."""
