"""The feature table: numbers that a vibration analyst would recognise, from acceleration, geometry and shaft speed."""
