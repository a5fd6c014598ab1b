"""Studies: the protocol, orders, sessions, storage, web pages and the command line."""
