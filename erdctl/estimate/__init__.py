"""Parameters from recordings: least squares, covariance, the paper's two steps. Names no effect."""
