# Sourced on the bench: the commands of Debian's package gpiod on gpiochip0. Releases 1 and 2 have different options.
if [[ $(gpioget --version) == *' v1.'* ]]; then
  read_line=(gpioget gpiochip0)
  read_line_pulled_down=(gpioget --bias=pull-down gpiochip0)
  hold_line=(gpioset --mode=signal gpiochip0) # until it is killed
  hold_line_5_ms=(gpioset --mode=time --usec=5000 gpiochip0)
  hold_line_50_ms=(gpioset --mode=time --usec=50000 gpiochip0)
  print_2000_edges=(gpiomon --num-events=2000 gpiochip0)
  print_falling_edges=(gpiomon --line-buffered --falling-edge gpiochip0)
else
  read_line=(gpioget --chip=gpiochip0 --numeric)
  read_line_pulled_down=(gpioget --chip=gpiochip0 --numeric --bias=pull-down)
  hold_line=(gpioset --chip=gpiochip0)
  hold_line_5_ms=(gpioset --chip=gpiochip0 --hold-period=5ms --toggle=0)
  hold_line_50_ms=(gpioset --chip=gpiochip0 --hold-period=50ms --toggle=0)
  print_2000_edges=(gpiomon --chip=gpiochip0 --num-events=2000)
  print_falling_edges=(stdbuf --output=L gpiomon --chip=gpiochip0 --edges=falling)
fi
