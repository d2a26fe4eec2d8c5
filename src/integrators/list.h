// How light is computed, one line each; the first is the paper's.
KIND(whitted)
KIND(path)
KIND(simplepath)
KIND(randomwalk)
KIND(ambientocclusion)
KIND(lightpath)
KIND(bdpt)
KIND(raster)
