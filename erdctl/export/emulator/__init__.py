"""The fault emulator as C: the `mimic` of Sec. 6, sample by sample, without the future."""
