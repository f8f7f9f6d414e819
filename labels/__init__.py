"""Labels: their schema, the truth they hold, and what is estimated from signals. Arrays in, arrays out."""
