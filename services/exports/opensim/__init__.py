"""OpenSim: coordinates as .mot and .sto, joint centres as .trc. Nothing here imports OpenSim."""
