"""Speech enhancement: the received audio of a call with less noise, before it is recognised."""
