"""What lies between the bearing and the file.

`mode` (a resonant path to the sensor), `mounting` (its low-pass) and `recorder`, joined in this order by `chain`.
"""
