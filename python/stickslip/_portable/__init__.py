"""The native module for any processor."""
