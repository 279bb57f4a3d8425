namespace flowdlo {}
