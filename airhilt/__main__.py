"""``python -m airhilt``."""

from airhilt.cli.main import main

main()
