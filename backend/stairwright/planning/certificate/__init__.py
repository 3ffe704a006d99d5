"""The independent check of plans: own geometry and statics, numpy and shapely, no native code."""
