"""Adapters for widely used libraries; each is short and meant to be copied.

    from immaculate.adapters import filterpy, functions, stonesoup

    immaculate.check(filterpy.Filter, kinds=["kalman"])
    immaculate.check(stonesoup.Filter, kinds=["unscented"], conventions=stonesoup.CONVENTIONS)
    immaculate.check(functions.filter_of(predict, update), kinds=["extended"])
"""
