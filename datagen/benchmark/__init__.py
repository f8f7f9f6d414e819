"""Benchmarks of classifiers: features of corpora, training, scoring, reports."""
