"""Adapters for what many people have; each is short and meant to be copied.

    from immaculate.adapters import filterpy, functions

    immaculate.check(filterpy.Filter, kinds=["kalman"])
    immaculate.check(functions.filter_of(predict, update), kinds=["extended"])
"""
