"""Wording: from an alert as structure to the message for each of its recipients."""
