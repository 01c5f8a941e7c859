"""The contract: the signals, their message models and the vocabulary. No behaviour, no service is imported."""
