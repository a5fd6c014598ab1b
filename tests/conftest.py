"""What every test shares: one hypothesis profile, deterministic and without deadlines (CI machines stall)."""

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
