// The kinds of film; the first is what a scene gets that names none.
KIND(rgb)
KIND(gbuffer)
KIND(spectral)
