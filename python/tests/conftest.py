"""What all tests need."""

import signal

# A job in the background of a shell starts with interrupts ignored, and Python then does not handle
# them.
signal.signal(signal.SIGINT, signal.default_int_handler)
