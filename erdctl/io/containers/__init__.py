"""MAT, HDF5, MDF4 and TDMS: files of channels with their own time bases, as one table and back.

They are read and written whole, in memory. One module for each format knows its library; all
others see channels only.
"""
