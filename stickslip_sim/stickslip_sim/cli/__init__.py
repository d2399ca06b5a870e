"""The offline tool `stickslip`: one file for each verb.  The only room that prints."""

from .main import main

__all__ = ['main']
