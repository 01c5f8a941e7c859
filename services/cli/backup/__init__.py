"""`ambula backup` and `ambula restore`: everything a site cannot compute anew, in one folder that can be checked."""
