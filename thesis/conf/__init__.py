"""Configurations that only the thesis needs, on the search path of conf/train.yaml."""
