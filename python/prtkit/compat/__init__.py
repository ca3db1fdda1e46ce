"""Replacements for files that other projects carry."""
