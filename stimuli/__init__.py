"""Robot motion and pictures: gestures, movement primitives, animation principles, robots, rendered clips."""
