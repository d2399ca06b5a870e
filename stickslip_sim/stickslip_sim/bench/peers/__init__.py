"""Simulators that one might use instead of this one, each behind the same few words (`peer.Peer`)."""
