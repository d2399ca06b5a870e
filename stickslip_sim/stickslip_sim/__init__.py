"""Exact, event-driven simulation of a feed axis with stick-slip friction."""

__version__ = '0.1.0'
