"""The independent check of plans: own geometry and statics, natively, in numpy and by shapely."""
