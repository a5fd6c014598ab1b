"""What every test shares: one hypothesis profile without deadlines, and a Ctrl-C that is heard."""

import signal

from hypothesis import HealthCheck, settings

settings.register_profile(
    "study",
    max_examples=25,
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("study")

# A run in the background inherits that Ctrl-C is ignored, and so would the programs that tests interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)
