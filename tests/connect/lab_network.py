"""The Lab Streaming Layer within one machine, for tests."""

# this machine and no other, by addresses instead of multicast
CONFIGURATION = """[ports]
IPv6 = disable
[multicast]
ResolveScope = machine
[lab]
KnownPeers = {{127.0.0.1}}
SessionID = test_{session}
[log]
level = -2
"""
