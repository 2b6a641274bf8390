"""The commands, one file each, with its ``COMMAND``.

A file in this package needs no registration. A command of another package is found by an entry
point of the group ``airhilt.commands`` that names a click command.
"""
