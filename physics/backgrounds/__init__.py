"""What a sensor shows besides the bearing: layers of noise, tones, impulses and other people's silence, in m/s²."""
