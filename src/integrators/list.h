// How light is computed, one line each; the first is the paper's.
KIND(whitted)
KIND(path)
KIND(volpath)
KIND(simplevolpath)
KIND(simplepath)
KIND(randomwalk)
KIND(ambientocclusion)
KIND(raster)
