"""The proof: hide an effect in an independent plant, diagnose its log alone, open the key, score.

seal -> examine -> judge for one case, `prove` for many in parallel, `summarise` for what came out.
"""
