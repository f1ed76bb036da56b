"""One self-contained HTML page for a result: no network, no server, nothing to install."""
