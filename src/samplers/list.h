// The kinds of sampler; the first is what a scene gets that names none.
KIND(zsobol)
KIND(independent)
KIND(stratified)
KIND(halton)
KIND(sobol)
KIND(paddedsobol)
KIND(pmj02bn)
