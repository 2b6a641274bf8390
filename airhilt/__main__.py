"""``python -m airhilt``."""

from airhilt.cli import main

main()
