"""From Python to the browser: server, messages, pages."""
