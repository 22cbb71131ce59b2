"""Pictures and videos of recordings: `hapticgiant render`."""
