"""The record of who read or changed what: append-only, each entry chained to the one before it."""
