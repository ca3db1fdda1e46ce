#include "prt/bake.h"
#include "prt/error.h"
#include <cstdio>
#include <cstdlib>
#include <cmath>
using namespace prt;
int main(int c,char**v){ try{ auto d=load_gltf(v[1]); auto s=extract_scene(d); for(auto&n:s.notices)puts(n.c_str());
 auto areas=receiver_areas(s); BakeOptions o; o.rays=c>2?atoi(v[2]):1024; Transfer ref; if(c>3){BakeOptions r=o;r.rays=65536;r.seed=7;ref=bake(s,r).baked.transfer;}
 for(int k=0;k<3;++k){auto b=bake(s,o); printf("build %.3f trace %.3f  %.2f Mrays/s vis %.5f\n",b.statistics.seconds_build,b.statistics.seconds_trace,b.statistics.rays_per_second/1e6,b.statistics.mean_visibility);
 if(c>3){double a=0,e=0;for(size_t p=0;p<ref.receivers();++p){double x=0,y=0;for(size_t i=0;i<ref.dimension();++i){double q=ref.vector(p)[i];double w=q-b.baked.transfer.vector(p)[i];x+=q*q;y+=w*w;}a+=x*areas[p];e+=y*areas[p];}printf("rel l2 %.5f\n",sqrt(e/a));}
 o.seed++; }
 }catch(std::exception&e){fprintf(stderr,"%s\n",e.what());return 1;} }
