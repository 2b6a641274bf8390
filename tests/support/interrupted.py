"""Runs a command that serves a page, and interrupts it as Ctrl+C does once it has told the URL.

python interrupted.py airhilt view RUN
"""

from __future__ import annotations

import signal
import subprocess
import sys

if __name__ == "__main__":
    process = subprocess.Popen(sys.argv[1:], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    with process.stdout:
        for line in process.stdout:
            sys.stdout.write(line)
            if line.startswith("http"):
                process.send_signal(signal.SIGINT)
    sys.exit(process.wait())
