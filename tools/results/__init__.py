"""The page of results: what is measured for it, its texts, and how they are filled.

`sections.SECTIONS` lists the sections in the order of the page; each has a text of its name here.
"""
