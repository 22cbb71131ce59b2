"""From requirements to a device that runs; docs/start/design.md."""
