"""Mutation testing: small changes to the code, and whether the tests notice them."""
