"""How long a spall is, from one record of vibration: event times, their lag, and the arc that goes with it."""
