"""What lies between the bearing and the file: resonant paths to the sensor, its mounting, the recorder."""
