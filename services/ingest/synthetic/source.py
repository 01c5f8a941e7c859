def open_synthetic(rest, identity):
    raise NotImplementedError
