"""The native module for x86-64-v3."""
