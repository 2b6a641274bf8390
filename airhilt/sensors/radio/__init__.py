"""The radio: calls on frequencies, the channel between, and what listeners make of them."""
