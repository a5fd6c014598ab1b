"""One statistic per file: arrays in, a frozen result out.

Notation: t, df, d, g, p as in reports; M mean, SD standard deviation (n − 1 in the denominator), SE standard
error; n counts observations after missing ones are dropped. A number that is not defined is None, and
`reason` says why; nothing here returns infinity, NaN or a p-value of exactly 0 for data of zero variance.

Only numpy and scipy.special are imported at the top of these files: a report on 34 participants takes
less time than importing the larger libraries.
"""
