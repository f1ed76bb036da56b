"""Any lab's text file: how it is written is recognised, said in one line, and then held to.

`recognise` looks at the beginning of a file and gives a `TextLayout`: encoding, separator, decimal
sign, header, units, kinds of columns. `read_text` reads columns by it, strictly: a cell that does
not fit is an error with its row, never another guess. Where two readings of the same text are
possible, both stop and name the option that decides.

None of the libraries that sniff dialects is used, for they answer with the likelier reading where
this must ask: csv.Sniffer and clevercsv know no decimal comma, header block or units row, dateutil
and pandas take 03/04 for a day without a word, and charset-normalizer decides among encodings in
which every number is the same. What parses the samples is pyarrow, in any dialect.
"""
