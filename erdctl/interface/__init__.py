"""The Python interface, one file a function; `import erdctl` shows them, see `help(erdctl)`."""
