"""The counterparts of the figures of Petersen et al. 2014 beside its numbers, and three questions it leaves open."""
