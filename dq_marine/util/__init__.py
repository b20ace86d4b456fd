"""Files written whole, optional libraries, and words to the user."""
